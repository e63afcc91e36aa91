#include "cablefit/model/equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cablefit {

std::vector<Imbalance> imbalances(const Transmission& transmission) {
  const Eigen::VectorXd q = transmission.reference_q();
  const Eigen::VectorXd theta = transmission.reference_theta() + transmission.encoder_zero();
  const Eigen::VectorXd f = transmission.tensions(q, theta);
  const Eigen::MatrixXd p = transmission.link_coupling(q), s = transmission.motor_coupling(theta);
  std::vector<Imbalance> all;
  const auto share = [&](const Eigen::MatrixXd& coupling, int joint, double torque) {
    const double pull = coupling.row(joint).cwiseAbs().dot(f);
    return pull > 0 ? std::abs(torque) / pull : 0.0;
  };
  for (int joint = 0; joint < transmission.n_joints; ++joint) {
    const double link = p.row(joint).dot(f), motor = s.row(joint).dot(f);
    const double most = std::max(share(p, joint, link), share(s, joint, motor));
    if (most > kBalanced) all.push_back({joint, link, motor, most});
  }
  return all;
}

std::string imbalance_text(const Imbalance& imbalance, int n_joints, Axes axes) {
  const std::string unit = torque_unit(axes);
  return fmt::format(
      "the preload is not in equilibrium, (8c): it makes {:.3g} {} on the link and {:.3g} {} on "
      "the "
      "motor{}, {:.0f} % of the sum of the cable torques; `cablefit design --balance` gives the "
      "nearest preload in equilibrium",
      imbalance.link, unit, imbalance.motor, unit,
      n_joints > 1 ? fmt::format(" of joint {}", imbalance.joint + 1) : "", 100 * imbalance.share);
}

}  // namespace cablefit
