#include "cablefit/simulate/arm_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cablefit/model/arm/arm_dynamics.hpp"
#include "cablefit/model/stiffness.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {
namespace {

constexpr double kAside = 1e-3;  // rad

/// diag(M(q), J_motor).
Eigen::MatrixXd inertias_at(const Model& model, const Eigen::VectorXd& q) {
  const Eigen::Index n = q.size();
  ArmDynamics arm = arm_dynamics(model.rig.arm, model.arm);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(n);
  arm.evaluate(q.data(), still.data());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  all.topLeftCorner(n, n) = Eigen::Map<const Eigen::MatrixXd>(arm.mass(), n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    all(n + k, n + k) = inertia_of(model.joints[static_cast<std::size_t>(k)].motor);
  return all;
}

/// K of a linear model: the springs between motors and links.
Eigen::MatrixXd spring_hessian(const Transmission& transmission) {
  const Eigen::Index n = transmission.n_joints;
  const Eigen::ArrayXd k = transmission.linear_stiffness, reduction = transmission.reductions();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  all.topLeftCorner(n, n).diagonal() = k * reduction.square();
  all.bottomRightCorner(n, n).diagonal() = k;
  all.topRightCorner(n, n).diagonal() = all.bottomLeftCorner(n, n).diagonal() = -k * reduction;
  return all;
}

}  // namespace

double stiffest_mode(const Model& model) {
  const Transmission& cables = model.transmission;
  const Eigen::VectorXd q = cables.reference_q();
  const Eigen::MatrixXd inertias = inertias_at(model, q);
  if (Eigen::LLT<Eigen::MatrixXd>(inertias).info() != Eigen::Success) return 0;
  double largest = 0;
  for (const double side : {kAside, -kAside}) {
    const Eigen::VectorXd theta = cables.reference_theta() + cables.encoder_zero() +
                                  Eigen::VectorXd::Constant(q.size(), side);
    const Eigen::MatrixXd hessian = cables.cables.empty()
                                        ? spring_hessian(cables)
                                        : stiffness_matrices(cables, q, theta).energy_hessian();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(hessian, inertias,
                                                                          Eigen::EigenvaluesOnly);
    largest = std::max(largest, modes.eigenvalues().maxCoeff());
  }
  return std::sqrt(largest);
}

double arm_step(double stiffest_mode) {
  const double shortest = SimulationOptions{}.step;
  if (!(stiffest_mode > 0)) return shortest;
  return std::clamp(kArmShare / stiffest_mode, shortest, 2 * shortest);
}

}  // namespace cablefit
