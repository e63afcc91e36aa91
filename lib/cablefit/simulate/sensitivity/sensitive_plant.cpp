#include "cablefit/simulate/sensitivity/sensitive_plant.hpp"

#include <algorithm>
#include <cassert>

#include "cablefit/simulate/refined_joint.hpp"

namespace cablefit {
namespace {

std::vector<SensitiveAxis> axes_of(const Model& model) {
  std::vector<SensitiveAxis> axes;
  if (!model.rigid)
    for (const JointModel& joint : model.joints) axes.emplace_back(joint.link);
  for (const JointModel& joint : model.joints) axes.emplace_back(joint.motor);
  return axes;
}

std::vector<int> numbered(std::size_t n) {
  std::vector<int> numbers;
  for (std::size_t k = 0; k < n; ++k) numbers.push_back(static_cast<int>(k));
  return numbers;
}

}  // namespace

SensitivePlant::SensitivePlant(const Model& model, const std::vector<ModelParameter>& moving,
                               bool with_inputs)
    : model_(model),
      moving_(moving),
      with_inputs_(with_inputs),
      axes_(axes_of(model)),
      coupling_(model, moving, numbered(moving.size())) {
  assert(is_plain(model));  // what refinements do has no sensitivities
  n_columns_ = moving.size() + (with_inputs ? 3 * axes_.size() : 0);
  for (SensitiveAxis& axis : axes_) axis_column_.emplace_back(axis.n_parameters(), -1);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const ModelParameter& p = moving[k];
    Target target;
    target.elastic = p.kind != ParameterKind::effect;
    if (!target.elastic) {
      target.axis =
          static_cast<std::size_t>(p.joint) + (model.rigid || p.on_link ? 0 : model.joints.size());
      target.place = p.effect;
      axis_column_[target.axis][target.place] = static_cast<int>(k);
    }
    targets_.push_back(target);
  }
  force_.resize(axes_.size());
  steps_.resize(axes_.size());
}

bool SensitivePlant::set_parameters(const double* values) {
  for (std::size_t k = 0; k < moving_.size(); ++k) {
    set_parameter_value(model_, moving_[k], values[k]);
    if (!targets_[k].elastic) axes_[targets_[k].axis].parameter(targets_[k].place) = values[k];
  }
  coupling_.update(model_);
  for (SensitiveAxis& axis : axes_) axis.update();
  return std::all_of(axes_.begin(), axes_.end(),
                     [](const SensitiveAxis& axis) { return axis.inertia() > 0; });
}

SensitiveState SensitivePlant::blank_state() const {
  SensitiveState state;
  state.position.assign(n_axes(), 0.0);
  state.velocity = state.position;
  state.by_position.assign(n_axes() * n_columns_, 0.0);
  state.by_velocity = state.by_position;
  reset_sensitivities(state);
  return state;
}

void SensitivePlant::reset_sensitivities(SensitiveState& state) const {
  std::fill(state.by_position.begin(), state.by_position.end(), 0.0);
  std::fill(state.by_velocity.begin(), state.by_velocity.end(), 0.0);
  if (!with_inputs_) return;
  const std::size_t n = n_axes();
  for (std::size_t a = 0; a < n; ++a) {
    state.by_position[a * n_columns_ + first_input() + a] = 1;
    state.by_velocity[a * n_columns_ + first_input() + n + a] = 1;
  }
}

void SensitivePlant::step(SensitiveState& state, const double* force, double h) {
  const std::size_t n = n_axes(), columns = n_columns_;
  const double half = 0.5 * h;
  for (std::size_t a = 0; a < n; ++a) state.position[a] += half * state.velocity[a];
  double* dx = state.by_position.data();
  double* dv = state.by_velocity.data();
  for (std::size_t i = 0; i < n * columns; ++i) dx[i] += half * dv[i];

  coupling_.evaluate(state.position.data(), force_.data());
  const double* stiffness = coupling_.stiffness().data();
  for (std::size_t a = 0; a < n; ++a) {
    const SensitiveAxis::Step s = axes_[a].advance(state.velocity[a], force_[a] + force[a], h);
    steps_[a] = s;
    state.velocity[a] = s.velocity;
    double* dva = dv + a * columns;
    for (std::size_t c = 0; c < columns; ++c) dva[c] *= s.by_velocity;
    for (std::size_t b = 0; b < n; ++b) {
      const double by = s.by_force * stiffness[a * n + b];
      const double* dxb = dx + b * columns;
      if (by == 0) continue;
      for (std::size_t c = 0; c < columns; ++c) dva[c] += by * dxb[c];
    }
    const std::vector<double>& own = axes_[a].by_parameter();
    for (std::size_t k = 0; k < own.size(); ++k)
      if (axis_column_[a][k] >= 0) dva[axis_column_[a][k]] += own[k];
    if (with_inputs_) dva[first_input() + 2 * n + a] += s.by_force;
  }
  for (const SensitiveCoupling::Entry& entry : coupling_.by_parameter())
    dv[entry.axis * columns + static_cast<std::size_t>(entry.column)] +=
        steps_[entry.axis].by_force * entry.value;

  for (std::size_t a = 0; a < n; ++a) state.position[a] += half * state.velocity[a];
  for (std::size_t i = 0; i < n * columns; ++i) dx[i] += half * dv[i];
}

}  // namespace cablefit
