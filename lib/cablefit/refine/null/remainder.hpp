// What even the best candidate leaves beyond the floor, as disturbance torques of the same colour:
// a search has to be judged against its gains under the null with such a disturbance. Internal to
// refine/.
#pragma once

#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/refine/rows/residual_spectrum.hpp"

namespace cablefit {

/// Autocovariance of the residual of every kind of rows.
using KindMemory = std::array<ResidualMemory, kRowKinds>;
KindMemory memory_of(const Design& design, const Eigen::VectorXd& x);

/// Mean over several of the same rows.
KindMemory mean_of(const std::vector<KindMemory>& several);

/// A first guess of what acts where rows remember `left`: all of it beyond the floor, in the same
/// colour. Kinds at their floor: nothing.
KindMemory remainder_of(const KindMemory& left, const KindLevels& floor);

/// A better one. `drawn`: what simulated rows remember under the guess, noise and all. A fit takes
/// some of what is slow, and kernels some of what is fast, from both alike.
KindMemory corrected(KindMemory guess, const KindMemory& left, const KindMemory& drawn);

/// As torques of one joint, autoregressive. `moves`: any row is in motion, else the motor's torque
/// is that of blocked rows.
CopyDisturbance as_disturbance(const KindMemory& remainder, bool moves);

bool is_quiet(const CopyDisturbance& disturbance);

}  // namespace cablefit
