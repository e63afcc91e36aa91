// The plant of a simulation with forward sensitivities: how its state depends on parameters, on the
// state that a stretch starts with and on the forces that drive it. Every column is a copy of the
// plant that is moved a little, so that whatever can be simulated has derivatives, by the same
// steps. Through cables that go slack they are continuous; an axis that comes to rest forgets its
// velocity's, and starts afresh when it leaves (set-valued friction, see simulator.hpp).
#pragma once

#include <vector>

#include "cablefit/model/model_parameters.hpp"
#include "cablefit/simulate/plant.hpp"

namespace cablefit {

/// State of all axes and its derivatives by C columns, axis by axis.
struct SensitiveState {
  std::vector<double> position, velocity;        ///< n_axes; rad, rad/s
  std::vector<double> by_position, by_velocity;  ///< their derivatives, [axis * C + column]
};

class SensitivePlant {
 public:
  /// One column per parameter of `moving`, then, if `with_inputs`, one per initial position, per
  /// initial velocity and per force. Axes: the links of all joints, then the motors; of rigid
  /// drives one each. A load law of q acts as the rig says.
  SensitivePlant(const Model& model, const std::vector<ModelParameter>& moving, bool with_inputs);

  std::size_t n_axes() const { return n_axes_; }
  double inertia(std::size_t axis) const { return plant_.inertia(axis); }
  /// Level of dry friction of an axis in the last step, N m.
  double rest_level(std::size_t axis) const { return plant_.dry_level(axis); }
  std::size_t n_columns() const { return copies_.size(); }
  std::size_t first_input() const { return moving_.size(); }

  /// Sets the parameters of `moving`, in order, and restarts. False: an axis has no positive
  /// inertia, or M(q) of an arm is not positive definite.
  bool set_parameters(const double* values);
  const Model& model() const { return model_; }

  /// Inner states of effects begin at 0 again.
  void restart() { make_copies(); }
  /// From this state on, at `t` (s since the log began); derivatives are 0 except those of the
  /// initial state by itself. Inner states of effects go on from the stretch before.
  void start(const double* position, const double* velocity, double t = 0);
  /// One step of h (s) under these forces (N m, n_axes: measured load on links, torque on motors)
  /// from the middle of the step.
  void step(const double* force, double h);
  void read(SensitiveState& state) const;

 private:
  struct Copy {
    Plant plant;
    double moved = 0;  ///< by how much its column's quantity is
  };

  void make_copies();
  /// Axis and kind (0: position, 1: velocity, 2: force) of a column of inputs.
  std::size_t axis_of(std::size_t column) const { return (column - first_input()) % n_axes_; }
  std::size_t kind_of(std::size_t column) const { return (column - first_input()) / n_axes_; }

  Model model_;
  std::vector<ModelParameter> moving_;
  std::size_t n_axes_;
  bool with_inputs_;
  Plant plant_;
  std::vector<Copy> copies_;  ///< one per column
  std::vector<double> position_, velocity_, force_;
};

}  // namespace cablefit
