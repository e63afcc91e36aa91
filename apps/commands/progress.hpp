// A line on a terminal's stderr while something takes longer than a second: what, and for how long.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace cablefit::apps {

/// Lives as long as the work; the line is gone afterwards. Silent when stderr is no terminal.
class Progress {
 public:
  Progress(bool quiet, std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  void show();

  std::string what_;
  std::mutex mutex_;
  std::condition_variable done_;
  bool is_done_ = false;
  std::thread thread_;
};

}  // namespace cablefit::apps
