// What the data do not determine, in words, with the combination that they do.
#pragma once

#include "cablefit/identify/elongations/judged_point.hpp"

namespace cablefit {

/// Why parameter `k` of the layout is not determined; empty when it is. For coefficients and l_o it
/// names a sum that is determined: "K1_0 + K2_0 = 3605 +- 4 N m/rad is".
std::string why_undetermined(const JointFit& fit, const JudgedPoint& judged, Eigen::Index k);

}  // namespace cablefit
