#include "output/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string_view>
#include <system_error>
#include <utility>

#include "output/progress_line.hpp"

namespace cablefit::apps {
namespace {

constexpr std::string_view kClearLine = "\r\x1b[K";
constexpr std::chrono::milliseconds kFirst{1000}, kNext{200};

volatile std::sig_atomic_t is_shown = 0;

void say(std::string_view text) { (void)std::fwrite(text.data(), 1, text.size(), stderr); }

/// A line that wraps could not be cleared.
std::size_t terminal_width() {
  winsize size{};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col - 1u : 79u;
}

}  // namespace

void clear_progress_line() noexcept {
  if (is_shown != 0 && ::write(STDERR_FILENO, kClearLine.data(), kClearLine.size()) < 0) return;
}

Progress::Progress(bool quiet, std::string what, bool tells_reading)
    : what_(std::move(what)), tells_reading_(tells_reading) {
  if (quiet || ::isatty(STDERR_FILENO) == 0) return;
  try {
    thread_ = std::thread([this] { show(); });
  } catch (const std::system_error&) {  // no more threads: the work goes on without a display
  }
}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_done_ = true;
  }
  done_.notify_one();
  thread_.join();
}

void Progress::rename(std::string what) {
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
}

void Progress::show() {
  ProgressLine line(what_, steady_seconds());
  std::unique_lock lock(mutex_);
  auto wait = kFirst;
  while (!done_.wait_for(lock, wait, [this] { return is_done_; })) {
    wait = kNext;
    is_shown = 1;
    line.rename(what_);
    say(fmt::format("{}{}", kClearLine,
                    line.at(steady_seconds(), tells_reading_ ? read_progress() : ReadProgress{},
                            terminal_width())));
  }
  if (is_shown != 0) say(kClearLine);
  is_shown = 0;
}

}  // namespace cablefit::apps
