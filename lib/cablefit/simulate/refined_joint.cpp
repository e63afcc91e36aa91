#include "cablefit/simulate/refined_joint.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "cablefit/model/effects/effect_walk.hpp"

namespace cablefit {
namespace {

/// Acts as a torque or as dry friction; other rows are in the cables or concern the log.
bool acts(const EffectInstance& instance) { return acts_as_torque(*instance.effect); }

double event_time_in(const EffectInstance& instance, std::size_t log_number) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (log_number == instance.event_log) return instance.event_time;
  return log_number < instance.event_log ? kNever : -kNever;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// A velocity half a step on, by what it was a step ago; no further than to rest.
double extrapolated(double velocity, double before) {
  const double middle = 1.5 * velocity - 0.5 * before;
  return middle * velocity > 0 ? middle : velocity;
}

}  // namespace

bool is_plain(const Model& model) {
  return std::all_of(model.joints.begin(), model.joints.end(), [](const JointModel& joint) {
    return std::none_of(joint.added.begin(), joint.added.end(), acts);
  });
}

RefinedJoint::RefinedJoint(const std::vector<EffectInstance>& refinements, std::size_t log_number) {
  for (const EffectInstance& instance : refinements)
    if (acts(instance)) terms_.push_back(make_term(instance, log_number));
}

RefinedJoint::Term RefinedJoint::make_term(const EffectInstance& instance, std::size_t log_number) {
  const Effect& row = *instance.effect;
  assert(instance.parameters.size() == row.parameters.size());
  Term term{&row, {}, {}, {}, event_time_in(instance, log_number), false, false, {}, {}};
  for (std::size_t i = 0; i < instance.parameters.size(); ++i)
    (i < row.n_linear() ? term.linear : term.shape).push_back(instance.parameters[i].value);
  term.z.resize(row.n_states);
  term.link.resize(row.n_linear());
  term.motor.resize(row.n_linear());
  JointState loaded, accelerated;
  loaded.tau_elas = loaded.qd = loaded.thetad = 1;
  if (row.level) term.is_directed = level(term, loaded, 1) != level(term, loaded, -1);
  accelerated.qdd = accelerated.thetadd = 1;
  if (row.torque) term.carries = torques(term, accelerated) != torques(term, {});
  return term;
}

/// On the link and on the motor.
std::pair<double, double> RefinedJoint::torques(Term& term, const JointState& state) {
  std::fill(term.link.begin(), term.link.end(), 0.0);
  std::fill(term.motor.begin(), term.motor.end(), 0.0);
  term.row->torque(state, term.shape.data(), term.z.data(), term.link.data(), term.motor.data());
  return {dot(term.linear, term.link), dot(term.linear, term.motor)};
}

double RefinedJoint::level(Term& term, const JointState& state, double direction) {
  std::fill(term.link.begin(), term.link.end(), 0.0);
  term.row->level(state, direction, term.shape.data(), term.z.data(), term.link.data());
  return dot(term.linear, term.link);
}

RefinedStep RefinedJoint::step(JointState state, double h) {
  const double qd = state.qd, thetad = state.thetad;
  if (has_jumped_) {
    qd_before_ = qd - qd_change_;
    thetad_before_ = thetad - thetad_change_;
  }
  if (has_begun_) {
    state.qd = extrapolated(qd, qd_before_);
    state.thetad = extrapolated(thetad, thetad_before_);
    qd_change_ = qd - qd_before_;
    thetad_change_ = thetad - thetad_before_;
  }
  has_begun_ = true;
  has_jumped_ = false;
  qd_before_ = qd;
  thetad_before_ = thetad;
  state.deflection_rate = state.thetad - state.qd;
  RefinedStep sum;
  for (Term& term : terms_) {
    state.since_event = state.t - term.event_time;
    act(term, state, h, sum);
  }
  return sum;
}

void RefinedJoint::take_history(const RefinedJoint& before) {
  assert(terms_.size() == before.terms_.size());
  for (std::size_t i = 0; i < terms_.size(); ++i) terms_[i].z = before.terms_[i].z;
  qd_change_ = before.qd_change_;
  thetad_change_ = before.thetad_change_;
}

void RefinedJoint::act(Term& term, const JointState& state, double h, RefinedStep& sum) {
  const Effect& row = *term.row;
  if (row.advance) row.advance(state, term.shape.data(), 0.5 * h, term.z.data());
  if (row.torque) {
    const auto [link, motor] = torques(term, state);
    sum.link_torque += link;
    sum.motor_torque += motor;
    if (term.carries) add_inertia(term, state, link, motor, sum);
  }
  if (row.level) {
    assert(row.site == Site::link || row.site == Site::motor);
    Axis::Extra& own = row.site == Site::link ? sum.link : sum.motor;
    const double up = level(term, state, 1);
    own.up += up;
    own.down += term.is_directed ? level(term, state, -1) : up;
  }
  if (row.advance) row.advance(state, term.shape.data(), 0.5 * h, term.z.data());
}

/// `link`, `motor`: the torques without acceleration.
void RefinedJoint::add_inertia(Term& term, JointState state, double link, double motor,
                               RefinedStep& sum) {
  state.qdd = state.thetadd = 1;
  const auto [more_link, more_motor] = torques(term, state);
  sum.link.inertia += more_link - link;
  sum.motor.inertia += more_motor - motor;
}

}  // namespace cablefit
