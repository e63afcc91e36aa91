// A line on a terminal's stderr while something takes longer than a second: what, how far the pass
// over the present log is, at what rate, and how long the rest of it takes.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace cablefit::apps {

/// Lives as long as the work; the line is gone afterwards. Silent when stderr is no terminal.
class Progress {
 public:
  /// `tells_reading`: of several pieces of work at a time no single log is worth telling.
  Progress(bool quiet, std::string what, bool tells_reading = true);
  ~Progress();
  /// What it says from now on; from any thread.
  void rename(std::string what);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  void show();

  std::string what_;
  std::mutex mutex_;
  std::condition_variable done_;
  bool is_done_ = false;
  bool tells_reading_;
  std::thread thread_;
};

/// For a signal handler.
void clear_progress_line() noexcept;

}  // namespace cablefit::apps
