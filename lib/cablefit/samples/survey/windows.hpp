// A log cut into windows on a fixed grid: each has a halo of neighbours on both sides, so that
// a window can be filtered and differenced on its own, on any thread, with the same bits as any
// other way.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// A segment is a stretch of evenly spaced rows without a gap, within one part. A window answers
/// for rows [begin, end) of its segment.
struct WindowPlace {
  std::size_t part = 0;     ///< index into LogSurvey::parts
  std::size_t segment = 0;  ///< running number within the log
  Eigen::Index begin = 0, end = 0;
  Eigen::Index first = 0;        ///< the row that its data begin with
  Eigen::Index rows_before = 0;  ///< rows of the log in earlier segments, whether used or not
  bool starts_segment = false;   ///< its data begin with the segment's first row
  bool ends_segment = false;     ///< and end with its last
  double t0 = 0;                 ///< time of the segment's row 0, s
  double period = 0;             ///< s
};

struct Window : WindowPlace {
  Eigen::MatrixXd data;  ///< rows [first, first + data.rows()) x LogPlan::slots, SI
  /// rows x joints: the direction (-1, 1; 0 before any motion) in which theta last moved by more
  /// than its noise. At rest this gives the side from which the position was approached.
  Eigen::MatrixXd approach;
};

/// What had to be done to get an even grid; printed in reports.
struct WindowCounts {
  std::size_t rows_read = 0;
  std::size_t rows_resampled = 0;  ///< rows made by linear interpolation
  std::size_t rows_too_short = 0;  ///< rows in segments shorter than `min_rows`
  std::size_t segments = 0;
  std::size_t rows_out = 0;  ///< rows of the even grid, over all segments
};

inline constexpr Eigen::Index kWindowRows = 8192;

/// One pass over the parts for which `wanted` says true. `halo` rows on either side where there are
/// any. `bridge`: holes up to this long (s) are interpolated over, a quarter period of the cut-off,
/// say; of an even clock those of up to three rows in any case; none so long that filling them all
/// would make more than four rows for each that is there. Longer ones begin a new segment.
/// Segments shorter than `min_rows` are left out and counted. Return false from `sink` to stop.
WindowCounts for_each_window(const LogSurvey& log,
                             const std::function<bool(const PartSurvey&)>& wanted,
                             Eigen::Index halo, Eigen::Index min_rows, double bridge,
                             const std::function<bool(Window&&)>& sink);

}  // namespace cablefit
