// How large a hidden effect is: rho, from the simulator's own signals and a least squares fit of
// its own. No code of the tool is involved.
//
// Rows: the link's and the motor's equation of the moving runs and the motor's equation of the
// blocked ones, smoothed by a Gaussian of 5.6 ms; rows within 17 ms of |v| < 0.02 rad/s on their
// own side are left out. Unknowns: the eleven base parameters, fitted to all rows at once, each
// equation weighted by its own floor.
//
//   floor_e  rms residual of that fit to the *logged* signals (counts, noise) of the effect-free
//   copy:
//            same rig, references and controller, no effect
//   gap_e    mean squared residual of that fit to the *exact* signals of the case, less that of the
//            exact signals of the copy (what filtering alone leaves)
//   rho_e = 1 + gap_e / floor_e^2,  rho = mean of rho_e over all rows
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulate.hpp"

namespace hidden {

/// W base = y, one row per kept sample (N m).
struct Rows {
  Eigen::MatrixXd W;
  Eigen::VectorXd y;
  std::vector<Eigen::Index> sample;  ///< which, counted over all runs
};

enum Equation { kLinkRows, kMotorRows, kBlockedRows, kEquations };
using PerEquation = Eigen::Array<double, kEquations, 1>;
using Equations = std::array<Rows, kEquations>;

/// J_link f_v f_s J_motor f_vm f_sm offset K1_0 K1_1 K2_0 K2_1.
constexpr int kBase = 11;
using Base = Eigen::Matrix<double, kBase, 1>;
Base base_of(const Rig& rig);

/// The rows of all runs. The torque is taken as held: its mean acts half a sample later.
Equations equations(const std::vector<Signals>& runs);

/// Fit with each equation weighted by 1/sd; equations without rows count for nothing.
Base fit(const Equations& rows, const PerEquation& sd);

/// Mean squared residual of each equation, N^2 m^2; 0 without rows.
PerEquation mean_square(const Equations& rows, const Base& base);

/// rms residual per equation of a fit whose weights are its own residuals (two passes), N m.
PerEquation floor_of(const Equations& logged_copy);

struct Rho {
  double all = 1;
  PerEquation each = PerEquation::Ones();
};
Rho rho_of(const Equations& exact_case, const Equations& exact_copy, const PerEquation& floor);

}  // namespace hidden
