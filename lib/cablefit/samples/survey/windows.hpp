// Cuts a log into windows on a fixed grid. Each has a halo of neighbouring rows on both sides, so
// it can be filtered and differenced alone, on any thread, and always gives the same bits.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// A segment is a stretch of evenly spaced rows without a gap, within one part. The results of a
/// window are for rows [begin, end) of its segment.
struct WindowPlace {
  std::size_t part = 0;     ///< index into LogSurvey::parts
  std::size_t segment = 0;  ///< running number within the log
  Eigen::Index begin = 0, end = 0;
  Eigen::Index first = 0;        ///< first row of its data
  Eigen::Index rows_before = 0;  ///< rows of the log in earlier segments, used or not
  bool starts_segment = false;   ///< its data begin with the segment's first row
  bool ends_segment = false;     ///< its data end with the segment's last row
  double t0 = 0;                 ///< time of the segment's row 0, s
  double period = 0;             ///< s
};

struct Window : WindowPlace {
  Eigen::MatrixXd data;  ///< rows [first, first + data.rows()) x LogPlan::slots, SI
  /// rows x joints: direction (-1, 1; 0 before any motion) in which theta last moved by more than
  /// its noise. At rest it is the side from which the position was approached.
  Eigen::MatrixXd approach;
};

/// Counts of the resampling to an even grid; printed in reports.
struct WindowCounts {
  std::size_t rows_read = 0;
  std::size_t rows_resampled = 0;  ///< rows made by linear interpolation
  std::size_t rows_too_short = 0;  ///< rows in segments shorter than `min_rows`
  std::size_t segments = 0;
  std::size_t rows_out = 0;  ///< rows of the even grid, over all segments
};

inline constexpr Eigen::Index kWindowRows = 8192;

/// One pass over the parts for which `wanted` is true. `halo`: rows on either side where the
/// segment has them. `bridge`: holes up to this length (s) are interpolated, such as a quarter
/// period of the cut-off. With an even clock holes of up to three rows are always interpolated. At
/// most four rows are filled in for each row of the part. A longer hole starts a new segment.
/// Segments shorter than `min_rows` are left out and counted. `sink` returns false to stop.
/// `window_rows`: of every window but the last of its segment.
WindowCounts for_each_window(const LogSurvey& log,
                             const std::function<bool(const PartSurvey&)>& wanted,
                             Eigen::Index halo, Eigen::Index min_rows, double bridge,
                             const std::function<bool(Window&&)>& sink,
                             Eigen::Index window_rows = kWindowRows);

}  // namespace cablefit
