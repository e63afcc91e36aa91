#include "cablefit/simulate/sensitivity/sensitive_plant.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

// What a copy is moved by. Rounding, 1e-16 of a state of 1, is 1e-6 of what the smallest of them
// makes in a row of 1 ms at the least; curvature (a cable of twice the slope in 1 mrad) 1e-4.
// Torques go by inertias: a drive of micronewtons has the derivatives of a large one.
constexpr double kPosition = 1e-7, kVelocity = 1e-6;        // rad, rad/s
constexpr double kAcceleration = 1e-2;                      // rad/s^2, of a force
constexpr double kShare = 1e-6;                             // of a parameter that is not 0
constexpr double kLeastAcceleration = 1e-6, kLeast = 1e-8;  // else: per unit of motion; in SI

std::size_t axes_of(const Model& model) { return model.joints.size() * (model.rigid ? 1 : 2); }

/// For a parameter that is 0. `inertia`: the smallest of the model.
double least_move(const Model& model, const ModelParameter& p, double inertia) {
  const bool is_length =
      p.kind == ParameterKind::elongation || p.kind == ParameterKind::encoder_zero;
  return is_length || shape_of(model, p) ? kLeast : kLeastAcceleration * inertia;
}

double larger_for(double unit, double value) { return unit * std::max(1.0, std::abs(value)); }

}  // namespace

SensitivePlant::SensitivePlant(const Model& model, const std::vector<ModelParameter>& moving,
                               bool with_inputs)
    : model_(model),
      moving_(moving),
      n_axes_(axes_of(model)),
      with_inputs_(with_inputs),
      plant_(model, {}, false),
      position_(n_axes_),
      velocity_(n_axes_),
      force_(n_axes_) {
  make_copies();
}

void SensitivePlant::make_copies() {
  plant_ = Plant(model_, {}, false);
  copies_.clear();
  double inertia = plant_.inertia(0);
  for (std::size_t axis = 1; axis < n_axes_; ++axis)
    inertia = std::min(inertia, plant_.inertia(axis));
  for (const ModelParameter& p : moving_) {
    const double value = parameter_value(model_, p);
    const double moved =
        std::max(kShare * std::abs(value), least_move(model_, p, std::abs(inertia)));
    set_parameter_value(model_, p, value + moved);
    copies_.push_back({Plant(model_, {}, false), moved});
    set_parameter_value(model_, p, value);
  }
  for (std::size_t k = 0; with_inputs_ && k < 3 * n_axes_; ++k) copies_.push_back({plant_, 0});
}

bool SensitivePlant::set_parameters(const double* values) {
  for (std::size_t k = 0; k < moving_.size(); ++k)
    set_parameter_value(model_, moving_[k], values[k]);
  make_copies();
  return plant_.is_sane();
}

void SensitivePlant::start(const double* position, const double* velocity, double t) {
  plant_.start(position, velocity, t);
  std::copy_n(position, n_axes_, position_.begin());
  std::copy_n(velocity, n_axes_, velocity_.begin());
  for (std::size_t column = 0; column < copies_.size(); ++column) {
    Copy& copy = copies_[column];
    if (column < first_input()) {
      copy.plant.start(position, velocity, t);
      continue;
    }
    const std::size_t axis = axis_of(column), kind = kind_of(column);
    copy.plant.take_history(plant_);
    copy.moved = kind == 0   ? larger_for(kPosition, position[axis])
                 : kind == 1 ? larger_for(kVelocity, velocity[axis])
                             : kAcceleration * plant_.inertia(axis);
    double& own = kind == 0 ? position_[axis] : velocity_[axis];
    const double value = own;
    if (kind < 2) own += copy.moved;
    if (kind < 2) copy.moved = own - value;  // as it is rounded
    copy.plant.start(position_.data(), velocity_.data(), t);
    own = value;
  }
}

void SensitivePlant::step(const double* force, double h) {
  plant_.step(force, h);
  std::copy_n(force, n_axes_, force_.begin());
  for (std::size_t column = 0; column < copies_.size(); ++column) {
    Copy& copy = copies_[column];
    const bool pushes = column >= first_input() && kind_of(column) == 2;
    if (!pushes) {
      copy.plant.step(force, h);
      continue;
    }
    double& own = force_[axis_of(column)];
    const double value = own;
    own += copy.moved;
    copy.plant.step(force_.data(), h);
    own = value;
  }
}

void SensitivePlant::read(SensitiveState& state) const {
  const std::size_t n = n_axes_, columns = n_columns();
  state.position.resize(n);
  state.velocity.resize(n);
  state.by_position.resize(n * columns);
  state.by_velocity.resize(n * columns);
  plant_.read(state.position.data(), state.velocity.data());
  std::vector<double> position(n), velocity(n);
  for (std::size_t c = 0; c < columns; ++c) {
    copies_[c].plant.read(position.data(), velocity.data());
    const double per = 1 / copies_[c].moved;
    for (std::size_t a = 0; a < n; ++a) {
      state.by_position[a * columns + c] = per * (position[a] - state.position[a]);
      state.by_velocity[a * columns + c] = per * (velocity[a] - state.velocity[a]);
    }
  }
}

}  // namespace cablefit
