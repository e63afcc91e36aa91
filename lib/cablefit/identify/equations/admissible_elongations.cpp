#include "cablefit/identify/equations/admissible_elongations.hpp"

#include <algorithm>

#include "cablefit/identify/equations/equilibrium.hpp"

namespace cablefit {
namespace {

constexpr int kRestorations = 3;

}  // namespace

void make_admissible(const PreloadJob& job, const std::vector<bool>& moves, Eigen::VectorXd& l_o) {
  if (can_balance(job.transmission, l_o)) return;
  double taut_and_fixed = 0;
  for (Eigen::Index c = 0; c < l_o.size(); ++c)
    if (!moves[static_cast<std::size_t>(c)]) taut_and_fixed = std::max(taut_and_fixed, l_o(c));
  for (Eigen::Index c = 0; c < l_o.size(); ++c) {
    if (!moves[static_cast<std::size_t>(c)]) continue;
    l_o(c) = taut_and_fixed > 0 ? std::max(l_o(c), taut_and_fixed) : std::min(l_o(c), 0.0);
  }
}

void restore_equilibrium(const PreloadJob& job, const std::vector<bool>& moves,
                         const Eigen::VectorXd& x, Eigen::VectorXd& l_o) {
  for (int i = 0; i < kRestorations; ++i) {
    if (!(l_o.array() > 0).all()) return;
    const Transmission cables = fitted_cables(job, l_o, x);
    double torque = 0;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(l_o.size());
    for (Eigen::Index c = 0; c < l_o.size(); ++c) {
      const Cable& cable = cables.cables[static_cast<std::size_t>(c)];
      const double gain = cable.motor_radii(cables.reference_theta())(0);
      torque += gain * cable.force(l_o(c));
      if (moves[static_cast<std::size_t>(c)]) gradient(c) = gain * cable.stiffness(l_o(c));
    }
    const double norm = gradient.squaredNorm();
    if (!(norm > 0)) return;
    const Eigen::VectorXd next = l_o - gradient * (torque / norm);
    if (!(next.array() > 0).all()) return;
    l_o = next;
  }
}

}  // namespace cablefit
