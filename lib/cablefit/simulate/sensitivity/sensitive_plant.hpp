// The plant of a simulation with forward sensitivities: how its state depends on parameters, on the
// initial state and on the forces that drive it (Hindmarsh & Serban 2005, "forward sensitivity
// analysis"; here the exact derivative of the discrete steps). Through cables that go slack they
// are continuous; an axis that comes to rest forgets its velocity's, and starts afresh when it
// leaves (set-valued friction, see simulator.hpp).
#pragma once

#include <vector>

#include "cablefit/model/model_parameters.hpp"
#include "cablefit/simulate/sensitivity/sensitive_axis.hpp"
#include "cablefit/simulate/sensitivity/sensitive_coupling.hpp"

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

  std::size_t n_axes() const { return axes_.size(); }
  double inertia(std::size_t axis) const { return axes_[axis].inertia(); }
  /// Level of dry friction of an axis at rest, N m.
  double rest_level(std::size_t axis) const { return axes_[axis].dry_level(); }
  std::size_t n_columns() const { return n_columns_; }
  std::size_t first_input() const { return moving_.size(); }

  /// Sets the parameters of `moving`, in order. False: an axis has no positive inertia.
  bool set_parameters(const double* values);
  const Model& model() const { return model_; }

  /// At rest at 0, derivatives 0 except those of the initial state by itself.
  SensitiveState blank_state() const;
  void reset_sensitivities(SensitiveState& state) const;

  /// One step of h (s) under these forces (N m, n_axes: measured load on links, torque on motors)
  /// from the middle of the step.
  void step(SensitiveState& state, const double* force, double h);

 private:
  struct Target {  ///< where a parameter of the list stands
    bool elastic = false;
    std::size_t axis = 0, place = 0;
  };

  Model model_;
  std::vector<ModelParameter> moving_;
  bool with_inputs_;
  std::size_t n_columns_;
  std::vector<SensitiveAxis> axes_;
  SensitiveCoupling coupling_;
  std::vector<Target> targets_;
  std::vector<std::vector<int>> axis_column_;  ///< per axis and parameter of it, -1: held
  std::vector<double> force_;
  std::vector<SensitiveAxis::Step> steps_;
};

}  // namespace cablefit
