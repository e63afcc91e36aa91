// A log made of windows of another one, with more channels or fewer rows. All code that reads logs
// can read it. Its rows are on the even grid of the windows.
#pragma once

#include <memory>

#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

class LogCopy {
 public:
  /// `from` must outlive it. `with_simulated`: every channel q and theta is there twice; the
  /// simulated ones are joints n, n + 1, ... 2 n - 1 of a rig with n joints.
  LogCopy(const LogSurvey& from, bool with_simulated);

  /// Adds rows [begin, end) of a window; windows must be in ascending order. `q`, `theta`:
  /// simulated, rows x joints; ignored without simulated channels.
  void add(const Window& window, const Eigen::ArrayXXd& q = {}, const Eigen::ArrayXXd& theta = {});
  LogSurvey finish();

 private:
  LogSurvey copy_;
  int n_joints_;
  Eigen::Index n_slots_;
  std::vector<Slot> simulated_;
  std::shared_ptr<SampleStore> store_ = std::make_shared<SampleStore>();
  std::size_t segment_ = 0;
  Eigen::Index end_ = -1;  ///< end of the last window added, in its segment
};

/// About `share` (0..1) of the wanted rows: stretches of kStretchWindows windows each, evenly
/// spaced over all logs together, each with a gap before it. Returns as many logs as were given.
std::vector<LogSurvey> stretches_of(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                    double share, double bridge);
inline constexpr int kStretchWindows = 4;

}  // namespace cablefit
