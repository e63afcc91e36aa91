#include "cablefit/samples/rows/signals.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

// The two values at either end repeat their neighbour and are never used (kDifferenceEdge).
void repeat_at_ends(Eigen::ArrayXd& x) {
  x.head(2).setConstant(x(2));
  x.tail(2).setConstant(x(x.size() - 3));
}

// d/dt of fourth order.
Eigen::ArrayXd first_derivative(const Eigen::ArrayXd& x, double h) {
  const Eigen::Index n = x.size(), m = n - 4;
  if (m < 1) return Eigen::ArrayXd::Zero(n);
  Eigen::ArrayXd v(n);
  v.segment(2, m) = (x.head(m) - x.tail(m) + 8 * (x.segment(3, m) - x.segment(1, m))) / (12 * h);
  repeat_at_ends(v);
  return v;
}

// d2/dt2 of fourth order.
Eigen::ArrayXd second_derivative(const Eigen::ArrayXd& x, double h) {
  const Eigen::Index n = x.size(), m = n - 4;
  if (m < 1) return Eigen::ArrayXd::Zero(n);
  Eigen::ArrayXd a(n);
  a.segment(2, m) =
      (16 * (x.segment(1, m) + x.segment(3, m)) - x.head(m) - x.tail(m) - 30 * x.segment(2, m)) /
      (12 * h * h);
  repeat_at_ends(a);
  return a;
}

// tau(t - delay) by linear interpolation between rows; for the usual delay of half a row this is
// the mean of tau[i-1] and tau[i], exactly what a second difference at i sees of a held torque.
Eigen::ArrayXd delayed(const Eigen::ArrayXd& tau, double rows) {
  const Eigen::Index n = tau.size();
  Eigen::ArrayXd out(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double at = std::max(0.0, static_cast<double>(i) - rows);
    const auto k = std::min(n - 1, static_cast<Eigen::Index>(at));
    const double share = at - static_cast<double>(k);
    out(i) = (1 - share) * tau(k) + (share > 0 ? share * tau(std::min(n - 1, k + 1)) : 0);
  }
  return out;
}

Eigen::ArrayXd column(const Eigen::MatrixXd& data, const LogPlan& plan, Channel channel,
                      int joint) {
  const int k = plan.find(channel, joint);
  return k < 0 ? Eigen::ArrayXd() : Eigen::ArrayXd(data.col(k).array());
}

JointSignals joint_signals(const Eigen::MatrixXd& data, const LogPlan& plan, int joint, double h,
                           const SignalSettings& settings) {
  JointSignals s;
  s.q = column(data, plan, Channel::q, joint);
  s.theta = column(data, plan, Channel::theta, joint);
  s.tau = column(data, plan, Channel::tau, joint);
  s.tau_load = column(data, plan, Channel::tau_load, joint);
  if (s.q.size() > 0) s.qd = first_derivative(s.q, h);
  if (s.theta.size() > 0) s.thetad = first_derivative(s.theta, h);
  const bool by_speed = plan.has(Channel::w, joint) && !plan.has_measured(Channel::theta, joint);
  if (by_speed) s.thetad = column(data, plan, Channel::w, joint);
  if (!settings.quasi_static) {
    if (s.q.size() > 0) s.qdd = second_derivative(s.q, h);
    if (s.theta.size() > 0)
      s.thetadd = by_speed ? first_derivative(s.thetad, h) : second_derivative(s.theta, h);
  }
  if (s.tau.size() > 0 && settings.torque_held) {
    const double hold = settings.torque_period > 0 ? settings.torque_period : h;
    s.tau = delayed(s.tau, hold / (2 * h));
  }
  const Load& load = plan.rig.load;
  if (load.law != nullptr && !load.law->from_column) {
    const Eigen::ArrayXd& position =
        s.q.size() > 0 ? s.q : s.theta;  // a rigid drive may log theta only
    s.tau_load = position.unaryExpr([&](double q) { return load.law->torque(load.parameters, q); });
  }
  return s;
}

void add_directions(std::vector<JointSignals>& joints, Eigen::Index n_rows,
                    const SignalFilter& filter) {
  for (JointSignals& s : joints) {
    Eigen::MatrixXd directions(n_rows, 2);
    directions.col(0) =
        s.qd.size() > 0 ? s.qd.sign().eval() : Eigen::ArrayXd::Zero(directions.rows()).eval();
    directions.col(1) = s.thetad.size() > 0 ? s.thetad.sign().eval()
                                            : Eigen::ArrayXd::Zero(directions.rows()).eval();
    filter.apply(directions);
    s.q_direction = directions.col(0);
    s.theta_direction = directions.col(1);
  }
}

}  // namespace

void SignalFilter::apply(Eigen::Ref<Eigen::MatrixXd> columns) const {
  if (low_pass) low_pass->apply(columns, starts_segment, ends_segment);
}

Eigen::Index Signals::n_rows() const {
  if (joints.empty()) return 0;
  return std::max(joints[0].q.size(), joints[0].theta.size());
}

Eigen::Index signal_halo(const SignalSettings& settings, double rate) {
  const Eigen::Index differences = kDifferenceEdge + 1;
  if (settings.cutoff <= 0) return differences;
  // Twice: the direction of motion is filtered after the signals it comes from.
  const int filters = settings.quasi_static ? 1 : 2;
  return filters * Butterworth(settings.filter_order, settings.cutoff, rate).settling_rows() +
         differences;
}

double bridge_seconds(const SignalSettings& settings) {
  return settings.cutoff > 0 ? 0.25 / settings.cutoff : 0;
}

Signals make_signals(const Window& window, const LogPlan& plan, const SignalSettings& settings) {
  Signals signals{window.first, window.begin, window.end, window.t0, window.period, {}};
  Eigen::MatrixXd data = window.data;
  signals.filter.starts_segment = window.starts_segment;
  signals.filter.ends_segment = window.ends_segment;
  if (settings.cutoff > 0)
    signals.filter.low_pass.emplace(settings.filter_order, settings.cutoff, 1 / window.period);
  signals.filter.apply(data);
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint) {
    signals.joints.push_back(joint_signals(data, plan, joint, window.period, settings));
    signals.joints.back().approach = window.approach.col(joint).array().sign();
  }
  if (!settings.quasi_static) add_directions(signals.joints, data.rows(), signals.filter);
  return signals;
}

}  // namespace cablefit
