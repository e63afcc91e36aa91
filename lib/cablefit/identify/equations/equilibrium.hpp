// Equilibrium of the preload alone, P f = S f = 0 in the reference pose: (8c)/(19e) of Fichera &
// Grossard 2017.
#pragma once

#include <optional>

#include "cablefit/identify/equations/joint_model.hpp"

namespace cablefit {

/// S f and P f as rows over the parameters of the layout, for these l_o; none where all cables are
/// slack, which balances by itself. `coefficients`: those about which l_o is linearised, then the
/// parameters go on with the changes of l_o. `place`: of the job.
Eigen::MatrixXd equilibrium_rows(const PreloadJob& job, int place, const Eigen::VectorXd& l_o,
                                 const JointLayout& layout,
                                 const std::optional<Eigen::VectorXd>& coefficients);

/// Whether cables with these elongations can balance each other in the reference pose: none is
/// taut, or P f = S f = 0 for some forces that are all positive.
bool can_balance(const Transmission& transmission, const Eigen::VectorXd& l_o);

}  // namespace cablefit
