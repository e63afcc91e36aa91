// Equilibrium of the preload alone, P f = S f = 0 of every joint in the reference pose: (8c)/(19e)
// of Fichera & Grossard 2017.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/identify/equations/joint_model.hpp"

namespace cablefit {

/// S and P in the reference pose under each other, 2 n_joints x n_cables, m.
Eigen::MatrixXd reference_coupling(const Transmission& transmission);

/// S f and P f as rows over the parameters of the layout, for these l_o; none where all cables are
/// slack, which balances by itself. `coefficients`: those about which l_o is linearised, then the
/// parameters go on with the changes of l_o, and of r_m: tied radii (joint_radii.hpp) stay in
/// balance. `place`: of the job.
Eigen::MatrixXd equilibrium_rows(const PreloadJob& job, int place, const Eigen::VectorXd& l_o,
                                 const JointLayout& layout,
                                 const std::optional<Eigen::VectorXd>& coefficients);

/// Whether cables with these elongations can balance each other in the reference pose: none is
/// taut, or P f = S f = 0 for some forces that are all positive.
bool can_balance(const Transmission& transmission, const Eigen::VectorXd& l_o);

/// Per cable whether it is taut and others that are taut can hold it there: it pulls in some
/// equilibrium in which no other cable pulls than those with l_o > 0.
std::vector<bool> balanced_cables(const Transmission& transmission, const Eigen::VectorXd& l_o);

/// Cables that act on each other, by way of the joints that they pass: places, ascending. Cables of
/// different groups neither balance each other nor stand in one equation.
std::vector<std::vector<std::size_t>> cable_groups(const Transmission& transmission);

}  // namespace cablefit
