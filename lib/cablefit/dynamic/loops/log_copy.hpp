// A log made of windows of another one, with more channels or fewer rows: what reads logs reads it
// as well. Its rows are on the even grid of the windows.
#pragma once

#include <memory>

#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {

class LogCopy {
 public:
  /// `from` must outlive it. `with_simulated`: every channel q and theta once more, as joints
  /// n, n + 1, ... 2 n - 1 of a rig that has n.
  LogCopy(const LogSurvey& from, bool with_simulated);

  /// Rows [begin, end) of the window; the next one, or a later one. `q`, `theta`: simulated, rows x
  /// joints; not looked at without simulated channels.
  void add(const Window& window, const Eigen::ArrayXXd& q = {}, const Eigen::ArrayXXd& theta = {});
  LogSurvey finish();

 private:
  LogSurvey copy_;
  int n_joints_;
  Eigen::Index n_slots_;
  std::vector<Slot> simulated_;
  std::shared_ptr<SampleStore> store_ = std::make_shared<SampleStore>();
  std::size_t segment_ = 0;
  Eigen::Index end_ = -1;  ///< of the last window added, in its segment
};

/// About `share` (0..1) of the wanted rows: stretches of kStretchWindows windows each, evenly
/// spaced over all logs together, every one as if a gap came before it. As many logs as were given.
std::vector<LogSurvey> stretches_of(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                    double share, double bridge);
inline constexpr int kStretchWindows = 4;

}  // namespace cablefit
