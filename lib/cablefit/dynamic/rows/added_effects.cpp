#include "cablefit/dynamic/rows/added_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/model/effect_parameter.hpp"
#include "cablefit/model/effect_walk.hpp"

namespace cablefit {
namespace {

constexpr double kStep = 0.01;  // of a nonlinear parameter, for its difference quotient

void require_torque(const Refinement& row) {
  if (row.correct == nullptr) return;
  throw usage_error(
      fmt::format("stage 2 does not fit '{}' ({}) of the model", row.name, to_string(row.site)),
      "mend the log or its rig file by it, or drop it from the model; 'cablefit refine' fits it");
}

/// Whether the equation of a side has it; of a transmission both have.
bool is_in_equation(const Refinement& row, Side side) {
  if (row.site == Site::transmission) return side != Side::rigid;
  if (row.site == Site::link)
    return side == Side::rigid ? counts_on_rigid(row) : side == Side::link;
  return side != Side::link;
}

std::vector<double> values_of(const RefinementInstance& instance, std::size_t from, std::size_t n) {
  std::vector<double> values;
  for (std::size_t k = from; k < from + n; ++k) values.push_back(instance.parameters[k].value);
  return values;
}

std::vector<double> linear_values(const RefinementInstance& instance) {
  return values_of(instance, 0, instance.refinement->n_linear());
}
std::vector<double> shape_values(const RefinementInstance& instance) {
  return values_of(instance, instance.refinement->n_linear(), instance.refinement->shape.size());
}

/// States of one joint over the rows of a window.
std::vector<JointState> states_of(const Transmission* cables, const Signals& signals,
                                  const JointSignals& s, int joint) {
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
    q[joint] = state.q;
    theta[joint] = state.theta;
    set_elastic(*cables, q, theta, joint, state);
    state.deflection_rate = state.thetad - state.qd;
  }
  return states;
}

/// Torque per unit of each linear parameter in the equation of the effect's side, rows x n_linear.
Eigen::MatrixXd torques(const AddedEffect& effect, const std::vector<double>& shape,
                        const std::vector<JointState>& states, const Eigen::ArrayXd& direction,
                        double period) {
  const Refinement& row = *effect.instance.refinement;
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

double step_of(const RefinementInstance& instance, std::size_t shape) {
  const ShapeGrid& grid = instance.refinement->shape[shape];
  const double value = instance.parameters[instance.refinement->n_linear() + shape].value;
  if (grid.is_geometric || grid.unit != GridUnit::si) return kStep * std::abs(value);
  return kStep * (grid.high - grid.low);
}

/// The law of the textbooks has its exponent; and refine gives no sd to what it did not look for.
bool is_settled(const RefinementInstance& instance, std::size_t shape) {
  const ShapeGrid& grid = instance.refinement->shape[shape];
  const Estimate& e = instance.parameters[instance.refinement->n_linear() + shape];
  return e.sd == 0 || (grid.canonical > 0 && e.value == grid.canonical);
}

AddedEffect in_equation(const RefinementInstance& instance, Side side) {
  AddedEffect effect{instance, side, instance.refinement->site == Site::transmission, {}};
  if (effect.is_held) return effect;
  for (std::size_t k = 0; k < instance.refinement->shape.size(); ++k)
    if (is_continuous(*instance.refinement, k) && !is_settled(instance, k) &&
        step_of(instance, k) > 0)
      effect.moving_shapes.push_back(k);
  return effect;
}

}  // namespace

Eigen::Index AddedEffect::n_columns() const {
  return static_cast<Eigen::Index>(instance.refinement->n_linear() + moving_shapes.size());
}

std::vector<AddedEffect> effects_of_side(std::span<const RefinementInstance> instances, Side side) {
  std::vector<AddedEffect> effects;
  for (const RefinementInstance& instance : instances) {
    require_torque(*instance.refinement);
    if (acts_as_torque(*instance.refinement) && is_in_equation(*instance.refinement, side))
      effects.push_back(in_equation(instance, side));
  }
  return effects;
}

std::vector<DynamicParameter> parameters_of(const AddedEffect& effect) {
  const Refinement& row = *effect.instance.refinement;
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
    p.origin = effect.instance.parameters[k].value;
    p.info.lower = -kUnbounded;
  }
  return parameters;
}

void fill_columns(const AddedEffect& effect, const Transmission* cables, const Signals& signals,
                  std::size_t joint, Eigen::Ref<Eigen::MatrixXd> out) {
  const JointSignals& s = signals.joints[joint];
  const std::vector<JointState> states = states_of(cables, signals, s, 0);
  const bool by_q = cables != nullptr && effect.instance.refinement->site == Site::link;
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
