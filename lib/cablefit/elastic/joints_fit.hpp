// Stage 1 of several joints (Fichera & Grossard 2017, (8b), (19), (25)): a blocked equation per
// joint,
//   tau_j = sum_i S_ji f_i(l_i) + offset_j +- f_sm_j,
// with the coefficients of a cable shared by all joints that it passes. The rows of all joints are
// fitted together, each joint's weighted with 1/variance of its own residual (Gautier 1997); joints
// without a common cable then come out as if each were fitted alone.
#pragma once

#include <string>

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"

namespace cablefit {

/// The fit of one preload of a rig with two joints or more. Encoder zeros are taken as known, or
/// with ZeroMode::theta_0 estimated instead of the offsets.
ElasticPreload fit_joints(ElasticJob job, const std::string& name);

}  // namespace cablefit
