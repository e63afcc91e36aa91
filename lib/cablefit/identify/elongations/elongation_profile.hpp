// Profile likelihood of the initial elongations (Raue et al. 2009): the likelihood of one l_o
// when everything else may follow.
#pragma once

#include <optional>

#include "cablefit/identify/elongations/elongation_search.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

struct ElongationProfiles {
  std::vector<ElongationProfile> profiles;
  std::optional<JointPoint>
      better;  ///< a place below `best`, met on the way: not the best after all
};

/// One profile per place in `which` (of the layout's parameters, all of l_o) about `best`.
/// `covariance`: of all parameters, to know where to look; `t`: per place, the quantile whose
/// square bounds the 95 % interval; `scale`: per place, what the deviance is multiplied with so
/// that its curvature is that of the robust variance (Kent 1982). Weights stay as they are.
ElongationProfiles profile_elongations(JointFit& fit, const JointPoint& best,
                                       const std::vector<Eigen::Index>& which,
                                       const Eigen::MatrixXd& covariance,
                                       const std::vector<double>& t,
                                       const std::vector<double>& scale);

}  // namespace cablefit
