#include "cablefit/design/loads/pose_stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"
#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/model/modes.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kMostSamples = 20000;  // of a log; more add nothing

/// Positions of all joints: q_1 .. q_n, theta_1 .. theta_n.
Equation positions(Eigen::Index n) {
  Equation equation;
  equation.name = "positions";
  equation.columns.assign(static_cast<std::size_t>(2 * n), "");
  equation.averaged.assign(static_cast<std::size_t>(2 * n), false);
  equation.fill = [n](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const JointSignals& s = signals.joints[static_cast<std::size_t>(k)];
      out.col(k) = s.q;
      out.col(n + k) = s.theta;
    }
  };
  return equation;
}

StiffnessAlong blank_along(const Transmission& transmission, const LogSurvey& log) {
  StiffnessAlong along;
  along.log = log.plan.path;
  along.least = Eigen::VectorXd::Constant(transmission.n_joints, kUnbounded);
  along.largest = -along.least;
  along.least_eigenvalue = kUnbounded;
  along.largest_eigenvalue = -kUnbounded;
  return along;
}

void add_pose(const PoseStiffness& pose, StiffnessAlong& along) {
  ++along.n_samples;
  along.n_closure += pose.elongation.minCoeff() > 0;
  along.n_passive += pose.modes.passive;
  const Eigen::VectorXd own = pose.joints.motor_theta.diagonal();
  along.least = along.least.cwiseMin(own);
  along.largest = along.largest.cwiseMax(own);
  along.least_eigenvalue = std::min(along.least_eigenvalue, pose.modes.motors_free.minCoeff());
  along.largest_eigenvalue = std::max(along.largest_eigenvalue, pose.modes.motors_free.maxCoeff());
}

}  // namespace

PoseStiffness stiffness_at_pose(const Transmission& transmission, std::string where,
                                const Eigen::VectorXd& q, const Eigen::VectorXd& theta) {
  PoseStiffness pose{std::move(where),
                     q,
                     theta,
                     transmission.elongations(q, theta),
                     transmission.tensions(q, theta),
                     cable_stiffnesses(transmission, q, theta),
                     stiffness_matrices(transmission, q, theta),
                     {}};
  pose.modes = stiffness_modes(pose.joints);
  return pose;
}

PoseStiffness stiffness_at_rest(const Transmission& transmission) {
  return stiffness_at_pose(transmission, "at rest", transmission.reference_q(),
                           transmission.reference_theta() + transmission.encoder_zero());
}

StiffnessAlong stiffness_along(const Transmission& transmission, const LogSurvey& log,
                               int threads) {
  const Eigen::Index n = transmission.n_joints;
  if (log.plan.rig.n_joints() != transmission.n_joints)
    throw input_error({log.plan.path, 0, 0},
                      fmt::format("{} joint(s), but the model has {}", log.plan.rig.n_joints(), n),
                      "give a log of the model's rig");
  StiffnessAlong along = blank_along(transmission, log);
  const auto all = [](const PartSurvey&) { return true; };
  RowSettings settings;
  const Eigen::Index rows = expected_rows(std::span(&log, 1), all, settings);
  settings.decimate = static_cast<int>(std::max<Eigen::Index>(1, rows / kMostSamples));
  const Equation equation = positions(n);
  stream_rows(
      std::span(&log, 1), all, settings, std::span(&equation, 1), threads,
      [](RowBatch batch) { return std::move(batch.equations.front().rows); },
      [&](const Eigen::MatrixXd& at) {
        for (Eigen::Index i = 0; i < at.rows(); ++i)
          add_pose(stiffness_at_pose(transmission, "", at.row(i).head(n), at.row(i).tail(n)),
                   along);
      });
  return along;
}

Balance nearest_balance(const Transmission& transmission) {
  const Transmission balanced = with_nearest_balance(transmission);
  const PreloadTorques now = preload_torques(transmission);
  Balance balance{now.link, now.motor, {}};
  for (std::size_t k = 0; k < transmission.cables.size(); ++k) {
    const Cable &own = transmission.cables[k], &other = balanced.cables[k];
    balance.cables.push_back({own.name, own.initial_elongation, own.force(own.initial_elongation),
                              other.initial_elongation, other.force(other.initial_elongation)});
  }
  return balance;
}

}  // namespace cablefit
