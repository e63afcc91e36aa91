// The elastic torque of one joint against its deflection, the other joints undeflected: what stage
// 1 measures, of cables that are known. phi: deflection from the reference pose, rad (m on a linear
// axis); torques on the motor, N m (N).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Made from a transmission that must outlive it.
class JointCurve {
 public:
  JointCurve(const Transmission& transmission, int joint);

  double torque(double phi) const;                ///< tau_elas_m of the joint
  double stiffness(double phi) const;             ///< d torque / d phi
  Eigen::VectorXd elongations(double phi) const;  ///< l per cable
  Eigen::VectorXd tensions(double phi) const;     ///< f per cable
  /// N m, sum of all tensions, each at its motor pulley.
  double tension_at_pulleys(double phi) const;

  /// The deflection nearest to 0 at which the torque is `torque`; nothing when the cables do not
  /// give it within kFarthest.
  std::optional<double> deflection_at(double torque) const;

  /// Positions of the other joints, and of this one at phi = 0; theta as logged.
  Eigen::VectorXd q() const { return q_; }
  Eigen::VectorXd theta(double phi) const;

  int joint() const { return joint_; }
  const Transmission& transmission() const { return *transmission_; }

 private:
  const Transmission* transmission_;
  int joint_;
  Eigen::VectorXd q_, theta_;
};

inline constexpr double kFarthest = 100;  ///< rad (or m); no cable stretches so far

/// Deflections around 0 between which all cables are taut, and the torques there: force closure,
/// Fichera & Grossard 2017, (12), Figs. 3d and 4. Infinite where no cable ever goes slack.
struct ClosureRange {
  double low = 0, high = 0;                ///< deflections
  double torque_low = 0, torque_high = 0;  ///< at them
  int cable_low = -1, cable_high = -1;     ///< which cable goes slack there
  /// The torque up to which all cables are taut in either direction; 0: some cable is never taut.
  double threshold() const;
};
ClosureRange closure_range(const JointCurve& curve);

/// Deflections from low to high at which some cable starts or ceases to pull, the ends included:
/// between two of them every cable law is smooth (but for its own knots).
std::vector<double> smooth_pieces(const JointCurve& curve, double low, double high);

}  // namespace cablefit
