#include "process.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "cablefit/base/files/output_file.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

/// The lowest free number is taken, so those before must be open already.
void open_if_closed(int stream) {
  if (::fcntl(stream, F_GETFD) >= 0) return;
  // Readable only: what is written to a closed stdout is lost, and has to be an error.
  (void)::open("/dev/null", O_RDONLY);
}

extern "C" void end_by_signal(int signal) {
  remove_temporaries();
  clear_progress_line();
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // comes once this handler has returned
}

/// A signal that was ignored from the start (nohup) stays ignored.
void handle(int signal) {
  struct sigaction now {};
  if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) return;
  struct sigaction ours {};
  ours.sa_handler = end_by_signal;
  sigfillset(&ours.sa_mask);
  ::sigaction(signal, &ours, nullptr);
}

// Windows of samples are allocated and freed by the megabyte. The C library would return each of
// them to the kernel and then request fresh, zeroed pages: a fifth of the run time.
void keep_memory() {
#ifdef __GLIBC__
  constexpr int kKeep = 64 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kKeep);
  ::mallopt(M_TRIM_THRESHOLD, kKeep);
#endif
}

}  // namespace

void prepare_process() {
  keep_memory();
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) open_if_closed(stream);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) handle(signal);
}

void complain(std::string_view message) noexcept {
  (void)std::fwrite(message.data(), 1, message.size(), stderr);
}

}  // namespace cablefit::apps
