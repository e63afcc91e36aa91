#include "cablefit/dynamic/rows/added_effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/model/effects/effect_walk.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/model/effects/path_friction.hpp"

namespace cablefit {
namespace {

constexpr double kQuotientStep = 0.01;  // of a nonlinear parameter, for its difference quotient
constexpr double kMostShare = 0.5;      // of it, or of its range, that one step may move it by

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

/// The measured motion of a joint, sample by sample.
JointState measured_state(const JointSignals& s, Eigen::Index i, bool is_rigid) {
  JointState state;
  state.theta = s.theta(i);
  state.thetad = s.thetad(i);
  state.thetadd = s.thetadd(i);
  state.q = is_rigid ? state.theta : s.q(i);
  state.qd = is_rigid ? state.thetad : s.qd(i);
  state.qdd = is_rigid ? state.thetadd : s.qdd(i);
  state.deflection_rate = state.thetad - state.qd;
  if (!is_rigid) return state;
  state.load = s.tau_load.size() > 0 ? s.tau_load(i) : 0;
  state.tau_elas = -state.load;
  return state;
}

std::span<const double> span_of(const Eigen::VectorXd& values) {
  return {values.data(), static_cast<std::size_t>(values.size())};
}

/// Positions and speeds of all links, and the cables' forces, at one sample.
class Links {
 public:
  Links(const Transmission& cables, std::span<const JointSignals> joints, bool with_paths)
      : cables_(cables),
        joints_(joints),
        q_(static_cast<Eigen::Index>(joints.size())),
        qd_(q_),
        theta_(q_),
        tension_(cables.cables.size()) {
    if (with_paths) path_ = PathFriction(cables.cables, 0);
  }

  bool has_paths() const { return !path_.is_empty(); }

  void set_state(Eigen::Index i, double period, int joint, JointState& state) {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      q_[at] = joints_[k].q(i);
      theta_[at] = joints_[k].theta(i);
      qd_[at] = joints_[k].qd(i);
    }
    set_elastic(cables_, q_, theta_, joint, state);
    if (path_.is_empty()) return;
    const Eigen::VectorXd turned = theta_ - cables_.encoder_zero();
    for (std::size_t k = 0; k < tension_.size(); ++k)
      tension_[k] = cables_.cables[k].force(cables_.cables[k].elongation(q_, turned));
    path_.advance(span_of(q_), span_of(qd_), period);
    state.path_friction = path_.on_link(static_cast<std::size_t>(joint), span_of(q_), tension_);
  }

 private:
  const Transmission& cables_;
  std::span<const JointSignals> joints_;
  Eigen::VectorXd q_, qd_, theta_;
  std::vector<double> tension_;
  PathFriction path_;
};

/// Torque per unit of each linear parameter in the equation of the effect's side, rows x n_linear.
Eigen::MatrixXd torques(const AddedEffect& effect, const std::vector<double>& shape,
                        const JointMotion& motion) {
  const std::vector<JointState>& states = motion.states;
  const bool by_q = !motion.is_rigid && effect.instance.effect->site == Site::link;
  const Eigen::ArrayXd& direction = by_q ? motion.q_direction : motion.theta_direction;
  const Effect& row = *effect.instance.effect;
  const auto n = static_cast<Eigen::Index>(row.n_linear());
  const auto n_rows = static_cast<Eigen::Index>(states.size());
  Eigen::MatrixXd link = Eigen::MatrixXd::Zero(n, n_rows), motor = link;
  EffectWalk walk(row, shape);
  for (Eigen::Index i = 0; i < n_rows; ++i)
    walk.step(states[static_cast<std::size_t>(i)], direction(i), motion.period, link.col(i).data(),
              motor.col(i).data());
  if (effect.side == Side::rigid && counts_on_rigid(row)) motor += link;
  return (effect.side == Side::link ? link : motor).transpose();
}

double step_of(const EffectInstance& instance, std::size_t shape) {
  const ShapeGrid& grid = instance.effect->shape[shape];
  const double value = instance.parameters[instance.effect->n_linear() + shape].value;
  if (grid.is_geometric || grid.unit != GridUnit::si) return kQuotientStep * std::abs(value);
  return kQuotientStep * (grid.high - grid.low);
}

/// The law of the textbooks has its exponent; and refine gives no sd to what it did not look for.
bool is_settled(const EffectInstance& instance, std::size_t shape) {
  const ShapeGrid& grid = instance.effect->shape[shape];
  const Estimate& e = instance.parameters[instance.effect->n_linear() + shape];
  return e.sd == 0 || (grid.canonical > 0 && e.value == grid.canonical);
}

AddedEffect in_equation(const EffectInstance& instance, Side side, int joint) {
  AddedEffect effect{instance, side, joint, is_of_both_sides(*instance.effect), {}};
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

/// "'stribeck' (motor)", of several joints "'stribeck' (motor 2)".
std::string name_of(const Effect& row, std::size_t joint, std::size_t n_joints) {
  return n_joints == 1 ? fmt::format("'{}' ({})", row.name, to_string(row.site))
                       : fmt::format("'{}' ({} {})", row.name, to_string(row.site), joint + 1);
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

void require_fittable(const EffectInstance& effect, const std::string& name, bool rigid,
                      bool has_paths) {
  const Effect& row = *effect.effect;
  const auto refuse = [&](const char* why, const char* hint) {
    throw usage_error(fmt::format("{} is not fitted here: {}", name, why), hint);
  };
  const bool has_values = std::all_of(effect.parameters.begin(), effect.parameters.end(),
                                      [](const Estimate& e) { return std::isfinite(e.value); });
  if (row.correct != nullptr)
    refuse("it is an error of a sensor or of the drive",
           "correct the log by its rig file, or drop it from the model; 'cablefit refine' fits it");
  if (!acts_as_torque(row))
    refuse("it changes the cables", "give the model its cables, or fit it with 'cablefit refine'");
  if (row.yardstick == Yardstick::shared_cable && !has_paths)
    refuse(rigid ? "a rigid drive has no cables" : "no cable passes several joints",
           "drop it from the model");
  if (row.yardstick != Yardstick::none && row.yardstick != Yardstick::shared_cable)
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

void require_fittable(const EffectsPerJoint& effects, bool rigid, std::span<const Cable> cables) {
  const bool has_paths = !rigid && std::any_of(cables.begin(), cables.end(), rubs_on_path);
  for (std::size_t joint = 0; joint < effects.size(); ++joint) {
    const std::vector<EffectInstance>& own = effects[joint];
    for (std::size_t k = 0; k < own.size(); ++k) {
      const std::string name = name_of(*own[k].effect, joint, effects.size());
      require_fittable(own[k], name, rigid, has_paths);
      for (std::size_t i = 0; i < k; ++i)
        if (own[i].effect == own[k].effect)
          throw usage_error(fmt::format("{} is given twice", name), "give it once");
    }
  }
}

Eigen::Index AddedEffect::n_columns() const {
  return static_cast<Eigen::Index>(instance.effect->n_linear() + moving_shapes.size());
}

std::vector<AddedEffect> effects_of_side(std::span<const EffectInstance> instances, Side side,
                                         int joint) {
  std::vector<AddedEffect> effects;
  for (const EffectInstance& instance : instances)
    if (acts_as_torque(*instance.effect) && is_in_equation(*instance.effect, side))
      effects.push_back(in_equation(instance, side, joint));
  return effects;
}

std::vector<DynamicParameter> parameters_of(const AddedEffect& effect, int n_joints) {
  const Effect& row = *effect.instance.effect;
  std::vector<DynamicParameter> parameters;
  const auto add = [&](std::size_t k) -> DynamicParameter& {
    DynamicParameter& p = parameters.emplace_back();
    p.info = row.parameters[k];
    p.name = added_parameter_name(row, p.info, effect.joint, n_joints);
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

namespace {

/// It jumps where a joint reverses, and the torque that it is part of went through the low-pass.
void smooth_path_friction(const SignalFilter& filter, std::vector<JointState>& states) {
  Eigen::MatrixXd friction(static_cast<Eigen::Index>(states.size()), 1);
  Eigen::Index row = 0;
  for (const JointState& state : states) friction(row++, 0) = state.path_friction;
  filter.apply(friction);
  row = 0;
  for (JointState& state : states) state.path_friction = friction(row++, 0);
}

}  // namespace

JointMotion joint_motion(const Transmission* cables, const Signals& signals, std::size_t at,
                         int joint, std::span<const AddedEffect> effects) {
  const JointSignals& own = signals.joints[at];
  JointMotion motion{{}, own.q_direction, own.theta_direction, signals.period, cables == nullptr};
  std::optional<Links> links;
  if (cables != nullptr) {
    const std::span<const JointSignals> all = signals.joints;
    const bool with_paths = std::any_of(effects.begin(), effects.end(), [](const AddedEffect& e) {
      return e.instance.effect->yardstick == Yardstick::shared_cable;
    });
    links.emplace(*cables,
                  all.subspan(at - static_cast<std::size_t>(joint),
                              static_cast<std::size_t>(cables->n_joints)),
                  with_paths);
  }
  const double began = signals.t0 - signals.log_began;
  for (Eigen::Index i = 0; i < own.theta.size(); ++i) {
    JointState& state = motion.states.emplace_back(measured_state(own, i, motion.is_rigid));
    state.t = began + static_cast<double>(i) * signals.period;
    state.since_event = state.t;  // what a model holds has happened before the log
    if (links) links->set_state(i, signals.period, joint, state);
  }
  if (links && links->has_paths()) smooth_path_friction(signals.filter, motion.states);
  return motion;
}

void fill_columns(const AddedEffect& effect, const JointMotion& motion,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  const auto with = [&](const std::vector<double>& shape) {
    return torques(effect, shape, motion);
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
