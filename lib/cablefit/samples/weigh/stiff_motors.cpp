#include "cablefit/samples/weigh/stiff_motors.hpp"

#include <Eigen/QR>

namespace cablefit::weighing {

Eigen::MatrixXd stiff_motors(const Rig& rig) {
  const int n = rig.n_joints();
  if (!rig.cables_given) return Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  const Eigen::MatrixXd link = rig.transmission.link_coupling(zero).transpose();
  const Eigen::MatrixXd motor = rig.transmission.motor_coupling(zero).transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motor);
  if (qr.rank() < n) return {};
  return qr.solve(link);
}

Eigen::ArrayXd stiff_theta(const Eigen::MatrixXd& stiff, const CoarsePart& part, int j) {
  Eigen::ArrayXd theta = Eigen::ArrayXd::Zero(part.t.size());
  for (Eigen::Index k = 0; k < stiff.cols(); ++k)
    theta += stiff(j, k) * part.joints[static_cast<std::size_t>(k)].q;
  return theta;
}

}  // namespace cablefit::weighing
