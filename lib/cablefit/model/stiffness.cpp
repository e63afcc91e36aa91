#include "cablefit/model/stiffness.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace cablefit {
namespace {

constexpr double kRoundedEigenvalue = 1e-9;  // of the largest eigenvalue

/// The linear model: tau_m = K phi, tau_l = N K phi, phi = theta - N q.
StiffnessMatrices of_spring(const Transmission& spring) {
  const Eigen::VectorXd& k = spring.linear_stiffness;
  const Eigen::VectorXd n = spring.reductions();
  const Eigen::MatrixXd coupled = n.cwiseProduct(k).asDiagonal();
  return {-Eigen::MatrixXd(n.cwiseProduct(n).cwiseProduct(k).asDiagonal()), coupled, -coupled,
          k.asDiagonal()};
}

/// sum_i f_i times the second derivatives of each cable's g or h at `angle`, joints x joints.
Eigen::MatrixXd turning_radii(const Transmission& transmission, const Eigen::VectorXd& f,
                              SideMaps (Cable::*side)() const, const Eigen::VectorXd& angle) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(transmission.n_joints, transmission.n_joints);
  const auto at = [&](std::size_t k) { return angle(static_cast<Eigen::Index>(k)); };
  for (Eigen::Index i = 0; i < f.size(); ++i)
    (transmission.cables[static_cast<std::size_t>(i)].*side)().add_slopes(at, f(i), sum);
  return sum;
}

Eigen::VectorXd eigenvalues_of(const Eigen::MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace

Eigen::MatrixXd StiffnessMatrices::energy_hessian() const {
  const Eigen::Index n = link_q.rows();
  Eigen::MatrixXd hessian(2 * n, 2 * n);
  hessian << -link_q, -link_theta, motor_q, motor_theta;
  return hessian;
}

Eigen::VectorXd cable_stiffnesses(const Transmission& transmission, const Eigen::VectorXd& q,
                                  const Eigen::VectorXd& theta) {
  Eigen::VectorXd k = transmission.elongations(q, theta);
  for (Eigen::Index i = 0; i < k.size(); ++i)
    k(i) = transmission.cables[static_cast<std::size_t>(i)].stiffness(k(i));
  return k;
}

StiffnessMatrices stiffness_matrices(const Transmission& transmission, const Eigen::VectorXd& q,
                                     const Eigen::VectorXd& theta) {
  if (transmission.cables.empty()) return of_spring(transmission);
  const Eigen::VectorXd turned = theta - transmission.encoder_zero();
  const Eigen::MatrixXd p = transmission.link_coupling(q), s = transmission.motor_coupling(theta);
  const Eigen::VectorXd f = transmission.tensions(q, theta);
  const Eigen::VectorXd k = cable_stiffnesses(transmission, q, theta);
  const Eigen::MatrixXd pk = p * k.asDiagonal(), sk = s * k.asDiagonal();
  StiffnessMatrices all{-pk * p.transpose(), pk * s.transpose(), -sk * p.transpose(),
                        sk * s.transpose()};
  all.link_q += turning_radii(transmission, f, &Cable::link_side, q);
  all.motor_theta += turning_radii(transmission, f, &Cable::motor_side, turned);
  return all;
}

StiffnessModes stiffness_modes(const StiffnessMatrices& matrices) {
  const Eigen::VectorXd all = eigenvalues_of(matrices.energy_hessian());
  return {eigenvalues_of(matrices.motor_theta), eigenvalues_of(-matrices.link_q),
          all.minCoeff() >= -kRoundedEigenvalue * all.cwiseAbs().maxCoeff()};
}

double free_resonance(double stiffness, double j_motor, double j_link) {
  return std::sqrt(stiffness * (1 / j_motor + 1 / j_link)) / (2 * std::numbers::pi);
}

double motor_stiffness(const Transmission& transmission, int joint, double phi) {
  Eigen::VectorXd theta = transmission.reference_theta() + transmission.encoder_zero();
  theta(joint) += phi;
  return stiffness_matrices(transmission, transmission.reference_q(), theta)
      .motor_theta(joint, joint);
}

}  // namespace cablefit
