#include "tests/fault/program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/temp_folder.hpp"

namespace cablefit::test {
namespace {

[[noreturn]] void become_program(const std::string& folder, const Arguments& arguments,
                                 const Environment& environment) {
  if (::chdir(folder.c_str()) != 0) ::_exit(99);
  const int err = ::open("err", O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int out = ::open("/dev/null", O_WRONLY);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  ::setenv("LD_PRELOAD", CABLEFIT_FAILING_CALLS, 1);
  ::setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1);
  std::vector<char*> argv{const_cast<char*>(CABLEFIT_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(CABLEFIT_PROGRAM, argv.data());
  ::_exit(99);
}

Ended end_of(pid_t process) {
  int status = 0;
  ::waitpid(process, &status, 0);
  Ended ended;
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  return ended;
}

}  // namespace

Ended run_program(const std::string& folder, const Arguments& arguments,
                  const Environment& environment, Blow blow) {
  // A signal must not find the child before it is the program, with the handlers of the test in it.
  sigset_t all, usual;
  sigfillset(&all);
  ::sigprocmask(SIG_BLOCK, &all, &usual);
  const pid_t process = ::fork();
  if (process == 0) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  }
  ::sigprocmask(SIG_SETMASK, &usual, nullptr);
  if (process == 0) become_program(folder, arguments, environment);
  if (blow.signal != 0) {
    std::this_thread::sleep_for(std::chrono::microseconds(blow.after_us));
    ::kill(process, blow.signal);
  }
  Ended ended = end_of(process);
  ended.err = content_of(folder + "/err");
  return ended;
}

}  // namespace cablefit::test
