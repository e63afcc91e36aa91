// The time axis of a plot over several logs or parts: each keeps its own length, one after the
// other. A single part keeps the times of its log.
#pragma once

#include <span>
#include <vector>

#include "cablefit/figure/thinned_line.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

class TimeAxis {
 public:
  /// The wanted parts of all logs, in order. `decimate`: raw rows per row that is drawn.
  TimeAxis(std::span<const LogSurvey> logs, const PartFilter& wanted, int decimate);

  /// Where on the axis the time t (s) of a part of a log is.
  double at(std::size_t log, std::size_t part, double t) const;

  ThinnedLine new_line() const { return {begin_, end_, spacing_}; }
  FigureAxis axis() const;

  /// A stretch in the middle of the longest part, short enough to be drawn row by row; there is
  /// none when the whole is.
  bool has_close_up() const { return near_end_ > near_begin_; }
  bool in_close_up(double x) const { return has_close_up() && x >= near_begin_ && x <= near_end_; }
  ThinnedLine new_close_up() const { return {near_begin_, near_end_, spacing_}; }
  /// Where each part begins, with the name of its log; none for a single part.
  const std::vector<Mark>& marks() const { return marks_; }
  double spacing() const { return spacing_; }  ///< s, of the rows drawn

 private:
  void choose_close_up(double begin, double end);

  std::vector<std::vector<double>> shifts_;  ///< by log and part, s
  std::vector<Mark> marks_;
  double begin_ = 0, end_ = 0, spacing_ = 0;
  double near_begin_ = 0, near_end_ = 0;
  std::size_t n_parts_ = 0;
};

}  // namespace cablefit
