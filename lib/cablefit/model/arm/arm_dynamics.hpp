// M(q) and C(q, qd) qd + g(q) of an arm by numbers, for the inner loop of a simulation: nothing is
// allocated after construction. Composite rigid bodies for M (Walker & Orin 1982) and recursive
// Newton-Euler for the rest (Luh, Walker & Paul 1980), both in spatial vectors about the origin of
// the base, where inertias and forces of links simply add (Featherstone 2008, ch. 5 and 6).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/arm.hpp"
#include "cablefit/model/arm/serial_chain.hpp"

namespace cablefit {

class ArmDynamics {
 public:
  /// Of the links' inertias in `chain`.
  explicit ArmDynamics(const SerialChain& chain);

  std::size_t n_joints() const { return joints_.size(); }
  /// At these positions and velocities (rad, rad/s; sliding m, m/s), n each in the rig's order.
  void evaluate(const double* q, const double* qd);

  /// M(q), n x n in the rig's order, row by row, kg m^2 (sliding: kg).
  const double* mass() const { return mass_.data(); }
  /// C(q, qd) qd + g(q), N m (sliding: N): what the joints have to give at constant speed.
  const double* bias() const { return bias_.data(); }

 private:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  /// A joint whose axis is z of its link's frame, and that link.
  struct Joint {
    Matrix rotation;  ///< of the frame at q = 0, in that of the link before
    Vector origin;
    double mass;
    Vector moment;   ///< first, kg m
    Matrix inertia;  ///< about the frame's origin
    std::size_t rig_joint;
    bool slides;
  };
  /// A link in the base's frame, about the base's origin. The sums are of it and all behind it.
  struct World {
    Matrix rotation;
    Vector origin;
    Vector turn, shift;            ///< motion per unit of the joint's speed
    Vector w, v, wd, vd;           ///< velocity; acceleration at qdd = 0, gravity taken off
    double mass;                   ///< sums
    Vector moment, torque, force;  ///< sums
    Matrix inertia;                ///< sum
  };

  void place(const Joint& joint, const World& before, double q, World& at) const;
  static void move(const World& before, double qd, World& at);
  static void load(const Joint& joint, World& at);
  void sum_up(std::size_t i);

  World base_;
  std::vector<Joint> joints_;
  std::vector<World> worlds_;
  std::vector<double> mass_, bias_;
};

/// Of a coupled arm with these values of its base parameters.
ArmDynamics arm_dynamics(const Arm& arm, std::span<const double> base);
ArmDynamics arm_dynamics(const Arm& arm, const std::vector<Estimate>& base);

}  // namespace cablefit
