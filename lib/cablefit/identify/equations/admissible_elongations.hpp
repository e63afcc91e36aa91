// Initial elongations that cables can have: in equilibrium where they are taut.
#pragma once

#include <vector>

#include "cablefit/identify/equations/joint_model.hpp"

namespace cablefit {

/// Cables that no others can balance are at most about to be taut; next to one that is held taut,
/// the others that act on it become taut as well. `moves`: per cable, its l_o may change.
void make_admissible(const PreloadJob& job, const std::vector<bool>& moves, Eigen::VectorXd& l_o);

/// Newton steps of least norm towards S f = P f = 0 of the taut cables in the reference pose, with
/// the coefficients `x`; none where a cable would go slack on the way.
void restore_equilibrium(const PreloadJob& job, const std::vector<bool>& moves,
                         const Eigen::VectorXd& x, Eigen::VectorXd& l_o);

}  // namespace cablefit
