#include "cablefit/simulate/plant.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr double kLargestState = 1e6;

std::vector<double> initial(const Eigen::VectorXd& value, std::size_t n) {
  if (value.size() == 0) return std::vector<double>(n, 0.0);
  return {value.begin(), value.end()};
}

bool all_bounded(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::abs(value) <= kLargestState; });
}

bool all_have_inertia(const std::vector<Axis>& axes) {
  return std::all_of(axes.begin(), axes.end(), [](const Axis& axis) { return axis.inertia() > 0; });
}

/// Empty where no joint has it.
PathFriction path_friction_of(const Model& model) {
  constexpr double kReversal = 2e-6;  // m
  const auto has_it = [](const JointModel& joint) {
    return std::any_of(joint.added.begin(), joint.added.end(), [](const EffectInstance& e) {
      return e.effect->yardstick == Yardstick::shared_cable;
    });
  };
  if (model.rigid || std::none_of(model.joints.begin(), model.joints.end(), has_it)) return {};
  return {model.transmission.cables, kReversal};
}

void write_row(const std::vector<double>& values, Eigen::Index row, Eigen::ArrayXXd* table) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    (*table)(row, static_cast<Eigen::Index>(k)) = values[k];
  }
}

}  // namespace

Plant::Plant(const Model& model, const SimulationInput& input, bool link_blocked)
    : is_rigid_(model.rigid),
      link_blocked_(link_blocked),
      load_(model.rig.load),
      coupling_(model.rigid ? Transmission{} : model.transmission),
      path_(path_friction_of(model)),
      t0_(input.t0) {
  const std::size_t n = model.joints.size();
  for (const JointModel& joint : model.joints) {
    motor_.emplace_back(joint.motor);
    if (!is_rigid_) link_.emplace_back(joint.link);
  }
  if (!is_plain(model))
    for (const JointModel& joint : model.joints)
      refined_.emplace_back(joint.added, input.log_number);
  q_ = initial(input.q0, n);
  qd_ = link_blocked ? std::vector<double>(n, 0.0) : initial(input.qd0, n);
  theta_ = initial(is_rigid_ && input.theta0.size() == 0 ? input.q0 : input.theta0, n);
  thetad_ = initial(is_rigid_ && input.thetad0.size() == 0 ? input.qd0 : input.thetad0, n);
  elastic_link_.resize(n);
  elastic_motor_.resize(n);
  extra_.resize(link_.size() + motor_.size());
  no_load_.resize(n);
  pulls_.resize(coupling_.n_cables());
  if (!path_.is_empty()) tension_.resize(coupling_.n_cables());
  if (model.is_coupled() && !is_rigid_) {
    arm_.emplace(model.rig.arm, model.arm, link_);
    arm_->start(q_.data(), qd_.data());
  }
}

void Plant::start(const double* position, const double* velocity, double t) {
  const std::size_t n = theta_.size(), n_links = link_.size();
  std::copy_n(position, n_links, q_.begin());
  std::copy_n(velocity, n_links, qd_.begin());
  std::copy_n(position + n_links, n, theta_.begin());
  std::copy_n(velocity + n_links, n, thetad_.begin());
  for (RefinedJoint& joint : refined_) joint.jump();
  if (arm_) arm_->start(q_.data(), qd_.data());
  t0_ = t;
  n_steps_ = 0;
}

void Plant::read(double* position, double* velocity) const {
  const std::size_t n = theta_.size(), n_links = link_.size();
  std::copy_n(q_.begin(), n_links, position);
  std::copy_n(qd_.begin(), n_links, velocity);
  std::copy_n(theta_.begin(), n, position + n_links);
  std::copy_n(thetad_.begin(), n, velocity + n_links);
}

double Plant::inertia(std::size_t number) const {
  const bool is_coupled = arm_ && number < link_.size();
  const double own = is_coupled ? arm_->inertia(number) : axis(number).inertia();
  return own + extra_[number].inertia;
}

double Plant::dry_level(std::size_t number) const {
  const Axis::Extra& extra = extra_[number];
  return std::max(axis(number).friction().level + std::max(extra.up, extra.down), 0.0);
}

void Plant::step(const double* force, double h) {
  if (is_rigid_) {
    step_rigid(force, no_load_.data(), h);
  } else {
    step_elastic(force + theta_.size(), force, h);
  }
}

void Plant::step(const double* tau, const double* tau_load, double h) {
  if (is_rigid_) {
    step_rigid(tau, tau_load, h);
  } else {
    step_elastic(tau, tau_load, h);
  }
}

void Plant::step_elastic(const double* tau, const double* tau_load, double h) {
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    theta_[k] += 0.5 * h * thetad_[k];
    q_[k] += 0.5 * h * qd_[k];
  }
  coupling_.pull(q_.data(), theta_.data(), pulls_.data());
  coupling_.torques(q_.data(), theta_.data(), pulls_.data(), elastic_link_.data(),
                    elastic_motor_.data());
  if (!refined_.empty()) {
    advance_refined(tau, tau_load, h);
    return;
  }
  advance_motors(tau, h);
  if (!link_blocked_) advance_links(tau_load, h);
}

void Plant::advance_motors(const double* tau, double h) {
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    thetad_[k] = motor_[k].advance(thetad_[k], tau[k] - elastic_motor_[k], h);
    theta_[k] += 0.5 * h * thetad_[k];
  }
}

void Plant::advance_links(const double* tau_load, double h) {
  if (arm_) return advance_arm(tau_load, h);
  for (std::size_t k = 0; k < q_.size(); ++k) {
    const double torque = elastic_link_[k] + tau_load[k] + load_at(q_[k]);
    qd_[k] = link_[k].advance(qd_[k], torque, h);
    q_[k] += 0.5 * h * qd_[k];
  }
}

void Plant::advance_arm(const double* tau_load, double h) {
  for (std::size_t k = 0; k < q_.size(); ++k)
    arm_->push(k, elastic_link_[k] + tau_load[k] + load_at(q_[k]), {});
  arm_->advance(q_.data(), qd_.data(), h);
  for (std::size_t k = 0; k < q_.size(); ++k) q_[k] += 0.5 * h * qd_[k];
}

JointState Plant::middle_of_step(std::size_t joint, double load, double h) const {
  JointState state;
  state.t = t0_ + (n_steps_ + 0.5) * h;
  state.theta = theta_[joint];
  state.thetad = thetad_[joint];
  state.q = is_rigid_ ? state.theta : q_[joint];
  state.qd = is_rigid_ ? state.thetad : qd_[joint];
  if (is_rigid_) {
    state.load = load;
    state.tau_elas = -load;
    return state;
  }
  coupling_.look(joint, q_.data(), theta_.data(), pulls_.data(), state);
  state.tau_elas = elastic_motor_[joint];
  if (!path_.is_empty()) state.path_friction = path_.on_link(joint, q_, tension_);
  return state;
}

void Plant::advance_path(double h) {
  if (path_.is_empty()) return;
  if (!link_blocked_) path_.advance(q_, qd_, h);
  for (std::size_t i = 0; i < tension_.size(); ++i) tension_[i] = pulls_[i].tension;
}

void Plant::advance_refined(const double* tau, const double* tau_load, double h) {
  advance_path(h);
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    const RefinedStep more = refined_[k].step(middle_of_step(k, 0, h), h);
    thetad_[k] = motor_[k].advance(thetad_[k], tau[k] - elastic_motor_[k] - more.motor_torque, h,
                                   more.motor);
    if (link_blocked_) continue;
    const double torque = elastic_link_[k] + tau_load[k] + load_at(q_[k]) - more.link_torque;
    if (arm_) {
      arm_->push(k, torque, more.link);
    } else {
      qd_[k] = link_[k].advance(qd_[k], torque, h, more.link);
    }
    extra_[k] = more.link;
    extra_[theta_.size() + k] = more.motor;
  }
  if (arm_ && !link_blocked_) arm_->advance(q_.data(), qd_.data(), h);
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    theta_[k] += 0.5 * h * thetad_[k];
    if (!link_blocked_) q_[k] += 0.5 * h * qd_[k];
  }
  ++n_steps_;
}

/// On the only axis what acts on either side: a torque between the sides has no effect.
void Plant::advance_refined_rigid(const double* tau, const double* tau_load, double h) {
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    theta_[k] += 0.5 * h * thetad_[k];
    const double load = tau_load[k] + load_at(theta_[k]);
    const RefinedStep more = refined_[k].step(middle_of_step(k, load, h), h);
    const double torque = tau[k] + load - more.motor_torque - more.link_torque;
    const Axis::Extra all{more.link.up + more.motor.up, more.link.down + more.motor.down,
                          more.link.inertia + more.motor.inertia};
    thetad_[k] = motor_[k].advance(thetad_[k], torque, h, all);
    extra_[k] = all;
    theta_[k] += 0.5 * h * thetad_[k];
  }
  ++n_steps_;
}

void Plant::step_rigid(const double* tau, const double* tau_load, double h) {
  if (!refined_.empty()) {
    advance_refined_rigid(tau, tau_load, h);
    return;
  }
  for (std::size_t k = 0; k < theta_.size(); ++k) {
    theta_[k] += 0.5 * h * thetad_[k];
    const double torque = tau[k] + tau_load[k] + load_at(theta_[k]);
    thetad_[k] = motor_[k].advance(thetad_[k], torque, h);
    theta_[k] += 0.5 * h * thetad_[k];
  }
}

void Plant::take_history(const Plant& before) {
  for (std::size_t k = 0; k < refined_.size(); ++k) refined_[k].take_history(before.refined_[k]);
  path_ = before.path_;
  if (arm_) arm_->take_history(*before.arm_);
}

bool Plant::is_sane() const {
  return all_bounded(q_) && all_bounded(qd_) && all_bounded(theta_) && all_bounded(thetad_) &&
         (arm_ ? arm_->is_sane() : all_have_inertia(link_)) && all_have_inertia(motor_);
}

void Plant::record(Eigen::Index row, SimulationResult* result) {
  write_row(is_rigid_ ? theta_ : q_, row, &result->q);
  write_row(is_rigid_ ? thetad_ : qd_, row, &result->qd);
  write_row(theta_, row, &result->theta);
  write_row(thetad_, row, &result->thetad);
  coupling_.pull(q_.data(), theta_.data(), pulls_.data());
  for (std::size_t i = 0; i < pulls_.size(); ++i)
    result->tension(row, static_cast<Eigen::Index>(i)) = pulls_[i].tension;
}

}  // namespace cablefit
