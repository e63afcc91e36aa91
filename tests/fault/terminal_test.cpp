// The progress line on a pseudo-terminal: shown for work of more than a second, gone afterwards.
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>

#include "tests/fault/bench.hpp"

namespace {

using namespace cablefit::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

constexpr const char* kClearLine = "\r\x1b[K";

struct Session {
  std::string screen;  ///< everything the program wrote to the terminal
  int status = 0;      ///< of waitpid()
};

/// The program in a terminal of its own. With `interrupt` Ctrl-C is typed once the line is there.
Session in_terminal(const std::string& command, bool interrupt) {
  termios settings{};
  ::cfmakeraw(&settings);
  settings.c_lflag |= ISIG;
  settings.c_cc[VINTR] = 3;
  winsize size{24, 100, 0, 0};
  int terminal = -1;
  const pid_t process = ::forkpty(&terminal, nullptr, &settings, &size);
  if (process == 0) {
    ::execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), static_cast<char*>(nullptr));
    ::_exit(99);
  }
  Session session;
  char block[4096];
  bool is_typed = false;
  for (ssize_t n = 0; (n = ::read(terminal, block, sizeof block)) > 0;) {
    session.screen.append(block, static_cast<std::size_t>(n));
    if (interrupt && !is_typed && session.screen.find("MB/s") != std::string::npos) {
      is_typed = ::write(terminal, "\x03", 1) == 1;
    }
  }
  ::waitpid(process, &session.status, 0);
  ::close(terminal);
  return session;
}

/// A log of 2 MB, each block of which takes a while to read: passes of some seconds.
std::string slow_check(const FaultBench& bench) {
  std::string rows = "t,q,theta,tau\n";
  for (int i = 0; rows.size() < (2u << 20); ++i) {
    const std::string sweep = std::to_string(std::abs(i % 200 - 100));
    rows += std::to_string(i) + "e-3,0," + sweep + "e-3," + sweep + "\n";
  }
  std::ofstream(bench.path("big.csv")) << rows;
  return "env LD_PRELOAD=" CABLEFIT_FAILING_CALLS
         " ASAN_OPTIONS=verify_asan_link_order=0 FAULT_READ_MS=200 " CABLEFIT_PROGRAM " check " +
         bench.path("big.csv") + " --json /dev/null";
}

TEST_CASE("progress tells file, share, rate and time left, and clears its line") {
  const FaultBench bench;
  const Session session = in_terminal(slow_check(bench) + " > /dev/null", false);
  INFO(session.screen);
  CHECK(WEXITSTATUS(session.status) == 0);
  CHECK_THAT(session.screen, Contains("reading logs: big.csv ["));
  CHECK_THAT(session.screen, Contains(" %, "));
  CHECK_THAT(session.screen, Contains(" MB/s, "));
  CHECK_THAT(session.screen, Contains(" s left"));
  CHECK_THAT(session.screen, Contains(kClearLine));
  const std::size_t last_line = session.screen.rfind("MB/s");
  CHECK(session.screen.find(kClearLine, last_line) != std::string::npos);
}

TEST_CASE("no progress with --quiet") {
  const FaultBench bench;
  const Session session = in_terminal(slow_check(bench) + " --quiet > /dev/null", false);
  CHECK(session.screen.find("reading") == std::string::npos);
}

TEST_CASE("Ctrl-C clears the line and ends the program by the signal") {
  const FaultBench bench;
  const Session session = in_terminal(slow_check(bench) + " > /dev/null", true);
  INFO(session.screen);
  CHECK(WIFSIGNALED(session.status));
  CHECK(WTERMSIG(session.status) == SIGINT);
  CHECK_THAT(session.screen, EndsWith(kClearLine));
}

}  // namespace
