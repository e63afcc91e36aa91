// A few windows of a long log, without a pass over all of its samples where that can be known.
#pragma once

#include <functional>

#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {

/// As for_each_window(), but only the windows for which `chosen` is true, and without
/// Window::approach. `chosen` is asked for each window in order. Of a part whose clock is even and
/// never stops no other samples are read, nor counted as read.
WindowCounts for_chosen_windows(const LogSurvey& log,
                                const std::function<bool(const PartSurvey&)>& wanted,
                                Eigen::Index halo, Eigen::Index min_rows, double bridge,
                                const std::function<bool(const WindowPlace&)>& chosen,
                                const std::function<bool(Window&&)>& sink);

}  // namespace cablefit
