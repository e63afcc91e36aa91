#include "cablefit/dynamic/rows/added_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/model/effects/effect_walk.hpp"

namespace cablefit {
namespace {

constexpr double kStep = 0.01;      // of a nonlinear parameter, for its difference quotient
constexpr double kMostShare = 0.5;  // of it, or of its range, that one step may move it by

/// In both equations, or held.
bool is_of_both_sides(const Effect& row) {
  return row.site == Site::transmission || row.site == Site::sensor;
}

bool is_in_equation(const Effect& row, Side side) {
  if (is_of_both_sides(row)) return side != Side::rigid;
  if (row.site == Site::link)
    return side == Side::rigid ? counts_on_rigid(row) : side == Side::link;
  return side != Side::link;
}

std::vector<double> values_of(const EffectInstance& instance, std::size_t from, std::size_t n) {
  std::vector<double> values;
  for (std::size_t k = from; k < from + n; ++k) values.push_back(instance.parameters[k].value);
  return values;
}

std::vector<double> linear_values(const EffectInstance& instance) {
  return values_of(instance, 0, instance.effect->n_linear());
}
std::vector<double> shape_values(const EffectInstance& instance) {
  return values_of(instance, instance.effect->n_linear(), instance.effect->shape.size());
}

/// States of the only joint over the rows of a window.
std::vector<JointState> states_of(const Transmission* cables, const Signals& signals,
                                  const JointSignals& s) {
  const bool is_rigid = cables == nullptr;
  std::vector<JointState> states(static_cast<std::size_t>(s.theta.size()));
  Eigen::VectorXd q = Eigen::VectorXd::Zero(is_rigid ? 1 : cables->n_joints), theta = q;
  const double began = signals.t0 - signals.log_began;
  for (Eigen::Index i = 0; i < s.theta.size(); ++i) {
    JointState& state = states[static_cast<std::size_t>(i)];
    state.t = began + static_cast<double>(i) * signals.period;
    state.since_event = state.t;  // what a model holds has happened before the log
    state.theta = s.theta(i);
    state.thetad = s.thetad(i);
    state.thetadd = s.thetadd(i);
    state.q = is_rigid ? state.theta : s.q(i);
    state.qd = is_rigid ? state.thetad : s.qd(i);
    state.qdd = is_rigid ? state.thetadd : s.qdd(i);
    if (is_rigid) {
      state.load = s.tau_load.size() > 0 ? s.tau_load(i) : 0;
      state.tau_elas = -state.load;
      continue;
    }
    q[0] = state.q;
    theta[0] = state.theta;
    set_elastic(*cables, q, theta, 0, state);
    state.deflection_rate = state.thetad - state.qd;
  }
  return states;
}

/// Torque per unit of each linear parameter in the equation of the effect's side, rows x n_linear.
Eigen::MatrixXd torques(const AddedEffect& effect, const std::vector<double>& shape,
                        const std::vector<JointState>& states, const Eigen::ArrayXd& direction,
                        double period) {
  const Effect& row = *effect.instance.effect;
  const auto n = static_cast<Eigen::Index>(row.n_linear());
  const auto n_rows = static_cast<Eigen::Index>(states.size());
  Eigen::MatrixXd link = Eigen::MatrixXd::Zero(n, n_rows), motor = link;
  EffectWalk walk(row, shape);
  for (Eigen::Index i = 0; i < n_rows; ++i)
    walk.step(states[static_cast<std::size_t>(i)], direction(i), period, link.col(i).data(),
              motor.col(i).data());
  if (effect.side == Side::rigid && counts_on_rigid(row)) motor += link;
  return (effect.side == Side::link ? link : motor).transpose();
}

double step_of(const EffectInstance& instance, std::size_t shape) {
  const ShapeGrid& grid = instance.effect->shape[shape];
  const double value = instance.parameters[instance.effect->n_linear() + shape].value;
  if (grid.is_geometric || grid.unit != GridUnit::si) return kStep * std::abs(value);
  return kStep * (grid.high - grid.low);
}

/// The law of the textbooks has its exponent; and refine gives no sd to what it did not look for.
bool is_settled(const EffectInstance& instance, std::size_t shape) {
  const ShapeGrid& grid = instance.effect->shape[shape];
  const Estimate& e = instance.parameters[instance.effect->n_linear() + shape];
  return e.sd == 0 || (grid.canonical > 0 && e.value == grid.canonical);
}

AddedEffect in_equation(const EffectInstance& instance, Side side) {
  AddedEffect effect{instance, side, is_of_both_sides(*instance.effect), {}};
  if (effect.is_held) return effect;
  for (std::size_t k = 0; k < instance.effect->shape.size(); ++k)
    if (is_continuous(*instance.effect, k) && !is_settled(instance, k) && step_of(instance, k) > 0)
      effect.moving_shapes.push_back(k);
  return effect;
}

}  // namespace

double DynamicParameter::moved(double step) const {
  const bool may_be_0 = lowest <= 0 && highest >= 0;
  const double whole =
      may_be_0 && std::isfinite(highest - lowest) ? highest - lowest : std::abs(origin);
  const double most = kMostShare * whole;
  return std::clamp(origin + std::clamp(step, -most, most), lowest, highest);
}

namespace {

std::string name_of(const Effect& row) {
  return fmt::format("'{}' ({})", row.name, to_string(row.site));
}

/// Whether its inner states change while nothing moves.
bool remembers_time(const EffectInstance& effect) {
  const Effect& row = *effect.effect;
  if (row.advance == nullptr) return false;
  const std::vector<double> shape = shape_values(effect);
  if (std::any_of(shape.begin(), shape.end(), [](double v) { return std::isnan(v); })) return false;
  std::vector<double> before(row.n_states), after;
  JointState state;
  state.tau_elas = state.deflection = state.stiffness = state.tension = 1;
  row.advance(state, shape.data(), 1e-3, before.data());
  after = before;
  state.tau_elas = 2;
  row.advance(state, shape.data(), 1, after.data());
  return after != before;
}

void require_fittable(const EffectInstance& effect, bool rigid) {
  const Effect& row = *effect.effect;
  const auto refuse = [&](const char* why, const char* hint) {
    throw usage_error(fmt::format("{} is not fitted here: {}", name_of(row), why), hint);
  };
  const bool has_values = std::all_of(effect.parameters.begin(), effect.parameters.end(),
                                      [](const Estimate& e) { return std::isfinite(e.value); });
  if (row.correct != nullptr)
    refuse("it is an error of a sensor or of the drive",
           "correct the log by its rig file, or drop it from the model; 'cablefit refine' fits it");
  if (!acts_as_torque(row))
    refuse("it changes the cables", "give the model its cables, or fit it with 'cablefit refine'");
  if (row.yardstick == Yardstick::shared_cable)
    refuse("it depends on the motion of all joints", "'cablefit refine' fits it");
  if (row.yardstick != Yardstick::none)
    refuse("a torque scale needs a known torque or inertia",
           "'cablefit refine' fits it where the logs or the rig file have one");
  if (row.is_event && !(row.lasts() && effect.event_log == 0 && effect.event_time == 0))
    refuse("it is an event", "give a model of the time after it, or fit it with 'cablefit refine'");
  if (remembers_time(effect))
    refuse("its memory is longer than the blocks in which logs are read",
           "drop it from the model; 'cablefit refine' fits it");
  if (rigid && !is_in_equation(row, Side::rigid))
    refuse("a rigid drive does not have it", "its one axis is the motor");
  if (is_of_both_sides(row) && !has_values)
    refuse("it acts on both sides, and is held at the value of a model",
           "'cablefit refine' fits it");
}

}  // namespace

void require_fittable(std::span<const EffectInstance> effects, bool rigid) {
  for (std::size_t k = 0; k < effects.size(); ++k) {
    require_fittable(effects[k], rigid);
    for (std::size_t i = 0; i < k; ++i)
      if (effects[i].effect == effects[k].effect)
        throw usage_error(fmt::format("{} is given twice", name_of(*effects[k].effect)),
                          "give it once");
  }
}

Eigen::Index AddedEffect::n_columns() const {
  return static_cast<Eigen::Index>(instance.effect->n_linear() + moving_shapes.size());
}

std::vector<AddedEffect> effects_of_side(std::span<const EffectInstance> instances, Side side) {
  std::vector<AddedEffect> effects;
  for (const EffectInstance& instance : instances)
    if (acts_as_torque(*instance.effect) && is_in_equation(*instance.effect, side))
      effects.push_back(in_equation(instance, side));
  return effects;
}

std::vector<DynamicParameter> parameters_of(const AddedEffect& effect) {
  const Effect& row = *effect.instance.effect;
  std::vector<DynamicParameter> parameters;
  const auto add = [&](std::size_t k) -> DynamicParameter& {
    DynamicParameter& p = parameters.emplace_back();
    p.info = row.parameters[k];
    p.name = added_parameter_name(row, p.info);
    return p;
  };
  for (std::size_t k = 0; k < row.n_linear(); ++k) {
    DynamicParameter& p = add(k);
    if (effect.is_held) p.given = effect.instance.parameters[k].value;
  }
  for (const std::size_t shape : effect.moving_shapes) {
    const std::size_t k = row.n_linear() + shape;
    DynamicParameter& p = add(k);
    const ShapeGrid& grid = row.shape[shape];
    const bool is_si = grid.unit == GridUnit::si;
    p.is_nonlinear = true;
    p.origin = effect.instance.parameters[k].value;
    p.lowest = std::max(p.info.lower, is_si ? grid.low : -kUnbounded);
    p.highest = std::min(p.info.upper, is_si ? grid.high : kUnbounded);
    // What came from other logs may lie outside, and goes no further out.
    p.lowest = std::min(p.lowest, p.origin);
    p.highest = std::max(p.highest, p.origin);
    p.info.lower = -kUnbounded;
    p.info.upper = kUnbounded;
  }
  return parameters;
}

void fill_columns(const AddedEffect& effect, const Transmission* cables, const Signals& signals,
                  std::size_t joint, Eigen::Ref<Eigen::MatrixXd> out) {
  const JointSignals& s = signals.joints[joint];
  const std::vector<JointState> states = states_of(cables, signals, s);
  const bool by_q = cables != nullptr && effect.instance.effect->site == Site::link;
  const Eigen::ArrayXd& direction = by_q ? s.q_direction : s.theta_direction;
  const auto with = [&](const std::vector<double>& shape) {
    return torques(effect, shape, states, direction, signals.period);
  };
  const std::vector<double> shape = shape_values(effect.instance);
  const std::vector<double> linear = linear_values(effect.instance);
  const Eigen::Map<const Eigen::VectorXd> size(linear.data(),
                                               static_cast<Eigen::Index>(linear.size()));
  out.leftCols(size.size()) = with(shape);
  Eigen::Index column = size.size();
  for (const std::size_t k : effect.moving_shapes) {
    std::vector<double> more = shape, less = shape;
    const double step = step_of(effect.instance, k);
    more[k] += step;
    less[k] -= step;
    out.col(column++) = (with(more) - with(less)) * size / (2 * step);
  }
}

}  // namespace cablefit
