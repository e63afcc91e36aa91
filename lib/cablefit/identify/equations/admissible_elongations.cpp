#include "cablefit/identify/equations/admissible_elongations.hpp"

#include <algorithm>

#include "cablefit/identify/equations/equilibrium.hpp"

namespace cablefit {
namespace {

constexpr int kRestorations = 3;
constexpr double kSameRow = 1e-12;  // of a row's square: what is left of it is rounding

/// l_o of the group's cables that stand still, taut, and are not balanced; 0: there are none.
double held_taut(const std::vector<std::size_t>& group, const std::vector<bool>& balanced,
                 const std::vector<bool>& moves, const Eigen::VectorXd& l_o) {
  double most = 0;
  for (const std::size_t c : group)
    if (!moves[c] && !balanced[c]) most = std::max(most, l_o(static_cast<Eigen::Index>(c)));
  return most;
}

/// The change of least norm that takes off `torque`; `gradient`: joints and sides x cables. Rows
/// that the ones before contain say nothing new (Gram-Schmidt).
Eigen::VectorXd newton_step(Eigen::MatrixXd gradient, Eigen::VectorXd torque) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(gradient.cols());
  for (Eigen::Index i = 0; i < gradient.rows(); ++i) {
    const double whole = gradient.row(i).squaredNorm();
    for (Eigen::Index j = 0; j < i; ++j) {
      const double norm = gradient.row(j).squaredNorm();
      if (!(norm > 0)) continue;
      const double share = gradient.row(i).dot(gradient.row(j)) / norm;
      gradient.row(i) -= share * gradient.row(j);
      torque(i) -= share * torque(j);
    }
    const double norm = gradient.row(i).squaredNorm();
    if (norm > kSameRow * whole)
      step -= gradient.row(i).transpose() * (torque(i) / norm);
    else
      gradient.row(i).setZero();
  }
  return step;
}

}  // namespace

void make_admissible(const PreloadJob& job, const std::vector<bool>& moves, Eigen::VectorXd& l_o) {
  if (can_balance(job.transmission, l_o)) return;
  const std::vector<bool> balanced = balanced_cables(job.transmission, l_o);
  for (const std::vector<std::size_t>& group : cable_groups(job.transmission)) {
    const double held = held_taut(group, balanced, moves, l_o);
    for (const std::size_t c : group) {
      double& own = l_o(static_cast<Eigen::Index>(c));
      if (!moves[c]) continue;
      if (held > 0)
        own = std::max(own, held);
      else if (!balanced[c])
        own = std::min(own, 0.0);
    }
  }
}

void restore_equilibrium(const PreloadJob& job, const std::vector<bool>& moves,
                         const Eigen::VectorXd& x, Eigen::VectorXd& l_o) {
  const Eigen::MatrixXd coupling = reference_coupling(job.transmission);
  for (int i = 0; i < kRestorations; ++i) {
    const Transmission cables = fitted_cables(job, l_o, x);
    Eigen::VectorXd torque = Eigen::VectorXd::Zero(coupling.rows());
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(coupling.rows(), l_o.size());
    for (Eigen::Index c = 0; c < l_o.size(); ++c) {
      if (!(l_o(c) > 0)) continue;
      const Cable& cable = cables.cables[static_cast<std::size_t>(c)];
      torque += coupling.col(c) * cable.force(l_o(c));
      if (moves[static_cast<std::size_t>(c)])
        gradient.col(c) = coupling.col(c) * cable.stiffness(l_o(c));
    }
    if (!(gradient.squaredNorm() > 0)) return;
    const Eigen::VectorXd next = l_o + newton_step(std::move(gradient), std::move(torque));
    for (Eigen::Index c = 0; c < l_o.size(); ++c)
      if (l_o(c) > 0 && !(next(c) > 0)) return;
    l_o = next;
  }
}

}  // namespace cablefit
