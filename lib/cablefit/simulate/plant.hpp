// The plant: all axes, the transmission between them and the load. Links of a coupled arm advance
// together, all other axes each for itself. Internal to the simulator.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/model/effects/path_friction.hpp"
#include "cablefit/simulate/axis.hpp"
#include "cablefit/simulate/coupled_links.hpp"
#include "cablefit/simulate/coupling.hpp"
#include "cablefit/simulate/refined_joint.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {

class Plant {
 public:
  Plant(const Model& model, const SimulationInput& input, bool link_blocked);

  /// One step of length h (s). tau and tau_load (N m): one per joint, at the middle of the step;
  /// tau_load is what the log gives, a load law of q is added.
  void step(const double* tau, const double* tau_load, double h);
  /// The same by axes: the links of all joints, then the motors; of rigid drives one each. `force`:
  /// measured load on links, torque on motors (rigid: their sum).
  void step(const double* force, double h);
  /// Goes on from these positions and velocities of the axes, at `t` (s since the log began).
  void start(const double* position, const double* velocity, double t);
  void read(double* position, double* velocity) const;
  /// Of an axis, with what effects beyond (31) added in the last step: inertia, and the level of
  /// dry friction that holds it at rest, N m.
  double inertia(std::size_t axis) const;
  double dry_level(std::size_t axis) const;

  /// Inner states of refinements, and last accelerations, as `before` has them, a plant of the same
  /// model.
  void take_history(const Plant& before);

  std::size_t n_joints() const { return theta_.size(); }
  const std::vector<double>& theta() const { return theta_; }
  /// Every state is finite and within +-1e6, every inertia positive; of a coupled arm M(q).
  bool is_sane() const;
  /// Writes positions, velocities and tensions into row `row` of the result.
  void record(Eigen::Index row, SimulationResult* result);

 private:
  double load_at(double position) const {
    return load_.law ? load_.law->torque(load_.parameters, position) : 0.0;
  }
  void step_elastic(const double* tau, const double* tau_load, double h);
  void step_rigid(const double* tau, const double* tau_load, double h);
  void advance_motors(const double* tau, double h);
  void advance_links(const double* tau_load, double h);
  void advance_arm(const double* tau_load, double h);
  /// The same with the refinements of the model.
  void advance_refined(const double* tau, const double* tau_load, double h);
  void advance_refined_rigid(const double* tau, const double* tau_load, double h);
  /// `load`: N m, of a rigid drive.
  const Axis& axis(std::size_t number) const {
    return number < link_.size() ? link_[number] : motor_[number - link_.size()];
  }
  void advance_path(double h);
  JointState middle_of_step(std::size_t joint, double load, double h) const;

  bool is_rigid_, link_blocked_;
  Load load_;
  std::vector<Axis> link_, motor_;
  std::optional<CoupledLinks> arm_;
  Coupling coupling_;
  std::vector<double> q_, qd_, theta_, thetad_;
  std::vector<Pull> pulls_;  ///< of the present step, or row that is recorded
  std::vector<double> elastic_link_, elastic_motor_;  ///< N m, of the present step
  std::vector<RefinedJoint> refined_;                 ///< empty: the model has none
  PathFriction path_;
  std::vector<double> tension_;     ///< N, per cable, where path_ is not empty
  std::vector<Axis::Extra> extra_;  ///< per axis, of the last step
  std::vector<double> no_load_;     ///< zeros, per joint
  double t0_;                       ///< s
  double n_steps_ = 0;              ///< counted for refinements
};

}  // namespace cablefit
