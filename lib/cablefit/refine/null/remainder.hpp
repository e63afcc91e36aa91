// Residual of the best candidate beyond the floor, as disturbance torques of the same colour. A
// search must be judged against its gains under the null with such a disturbance. Internal to
// refine/.
#pragma once

#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/refine/rows/residual_spectrum.hpp"

namespace cablefit {

/// Autocovariance of the residual of every kind of rows.
using KindMemory = std::array<ResidualMemory, kRowKinds>;
KindMemory memory_of(const Design& design, const Eigen::VectorXd& x);

/// Mean over several sets for the same rows.
KindMemory mean_of(const std::vector<KindMemory>& several);

/// A first guess of the disturbance where rows have the autocovariance `left`: all of it beyond the
/// floor, in the same colour. Kinds at their floor have none.
KindMemory remainder_of(const KindMemory& left, const KindLevels& floor);

/// An improved guess. `drawn`: autocovariance of simulated rows under the guess, with noise. The
/// fit removes some of the slow part, and kernels some of the fast part, from both alike.
KindMemory corrected(KindMemory guess, const KindMemory& left, const KindMemory& drawn);

/// As autoregressive torques of one joint. `moves`: any row is in motion; otherwise the motor's
/// torque is that of blocked rows.
CopyDisturbance as_disturbance(const KindMemory& remainder, bool moves);

bool is_quiet(const CopyDisturbance& disturbance);

}  // namespace cablefit
