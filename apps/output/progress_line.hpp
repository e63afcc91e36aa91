// The text of the progress line, apart from where and when it is shown.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "cablefit/base/files/read_progress.hpp"

namespace cablefit::apps {

/// Follows one piece of work. A log is read several times, and the number is not known beforehand.
/// So the line shows the progress of the present pass over the present file.
class ProgressLine {
 public:
  /// Work that begins at `start`, s on the clock of read_progress.hpp.
  ProgressLine(std::string what, double start) : what_(std::move(what)), start_(start) {}

  /// "reading logs: big.csv [####....]  45 %, 230 MB/s, 3 s left" once a pass takes longer than a
  /// second, "fitting stage 1 ... 12 s" while nothing is read; at most `width` characters.
  std::string at(double seconds, const ReadProgress& now, std::size_t width);
  /// "12 s", "3 min 5 s".
  static std::string duration(double seconds);
  void rename(const std::string& what) { what_ = what; }

 private:
  std::string what_;
  double start_;
  ReadProgress latest_;
  double latest_read_ = 0;  // when bytes last arrived
};

}  // namespace cablefit::apps
