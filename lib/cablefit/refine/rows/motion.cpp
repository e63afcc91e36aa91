#include "cablefit/refine/rows/motion.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "cablefit/elastic/rows/elastic_columns.hpp"
#include "cablefit/model/effects/path_friction.hpp"
#include "cablefit/model/one_joint.hpp"

namespace cablefit {
namespace {

constexpr double kSamplesPerWidth = 1.5;  // a kernel narrower than this aliases

Eigen::ArrayXXd apply_to_columns(const Kernel& kernel, const Eigen::ArrayXXd& columns) {
  Eigen::ArrayXXd out(columns.rows(), columns.cols());
  for (Eigen::Index k = 0; k < columns.cols(); ++k) out.col(k) = apply(kernel, columns.col(k));
  return out;
}

/// Torque on the motor of every sample, and the sum of what the cables contribute to it by amount;
/// with the motor `turned` (rad) from where it is.
struct ElasticTorque {
  Eigen::ArrayXd sum, amounts;
};

ElasticTorque elastic_torque(const Transmission& transmission, const SmoothMotion& m,
                             double turned) {
  const Eigen::ArrayXd theta = m.theta + turned;
  if (transmission.cables.empty()) {
    const Eigen::ArrayXd tau =
        transmission.linear_stiffness(0) * transmission.deflections(0, m.q, theta);
    return {tau, tau.abs()};
  }
  JointSignals signals;
  signals.q = m.q;
  signals.theta = theta;
  Eigen::MatrixXd basis(m.size(), n_elastic_columns(transmission));
  elastic_basis(transmission, signals, ElasticSide::motor, basis, m.others);
  ElasticTorque torque{Eigen::ArrayXd::Zero(m.size()), Eigen::ArrayXd::Zero(m.size())};
  Eigen::Index first = 0;
  for (const Cable& cable : transmission.cables) {
    const Eigen::Map<const Eigen::VectorXd> coefficients(cable.coefficients.data(),
                                                         cable.n_coefficients());
    const Eigen::ArrayXd own = basis.middleCols(first, coefficients.size()) * coefficients;
    torque.sum += own;
    torque.amounts += own.abs();
    first += coefficients.size();
  }
  return torque;
}

}  // namespace

std::string_view to_string(RowKind kind) {
  return kind == RowKind::link ? "link" : kind == RowKind::motor ? "motor" : "blocked";
}

Eigen::Index stride_for(double columns, double period, Eigen::Index every) {
  const double evaluations = kRowSpacing * columns / period / static_cast<double>(every);
  return every * std::max<Eigen::Index>(1, std::llround(evaluations));
}

Smoothing smoothing_for(double period) {
  constexpr double kRounding = 1e-6;
  Smoothing s;
  s.signals = std::max(s.signals, kSamplesPerWidth * period);
  s.columns = 2 * s.signals;
  const double samples = kEvaluationSpacing * s.columns / period;
  s.every = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(samples + kRounding));
  s.stride = stride_for(s.columns, period, s.every);
  s.period = period;
  return s;
}

Smoothing suited(const Smoothing& smoothing, double period) {
  if (period == smoothing.period) return smoothing;
  const double wider = std::max(1.0, kSamplesPerWidth * period / smoothing.signals);
  const auto samples = [&](double seconds, Eigen::Index unit) {
    const double units = seconds / period / static_cast<double>(unit);
    return unit * std::max<Eigen::Index>(1, std::llround(units));
  };
  Smoothing s = smoothing;
  s.signals *= wider;
  s.columns *= wider;
  const double every = static_cast<double>(smoothing.every) * smoothing.period;
  s.every = samples(std::min(every, kEvaluationSpacing * s.columns), 1);
  s.stride = samples(wider * static_cast<double>(smoothing.stride) * smoothing.period, s.every);
  s.period = period;
  return s;
}

double torque_lateness(const Rig& rig, double period) {
  if (rig.torque_hold == TorqueHold::none) return 0;
  return 0.5 * (rig.torque_period > 0 ? std::min(1.0, rig.torque_period / period) : 1.0);
}

SmoothMotion smooth_motion_of(const Recording& r, double t0, double late,
                              const Smoothing& smoothing, bool of_arm) {
  const Kernel smooth = gaussian(smoothing.signals, r.period);
  const Kernel slope = gaussian_slope(smoothing.signals, r.period);
  const Kernel curvature = gaussian_curvature(smoothing.signals, r.period);
  SmoothMotion m;
  m.t0 = t0;
  m.period = r.period;
  m.q = apply(smooth, r.q);
  m.qd = apply(slope, r.q);
  m.qdd = apply(curvature, r.q);
  m.theta = apply(smooth, r.theta);
  m.thetad = apply(slope, r.theta);
  m.thetadd = apply(curvature, r.theta);
  m.tau_load = apply(smooth, r.tau_load);
  m.tau = smooth_torque(r, late, smoothing);
  m.q_direction = m.qd.sign();
  m.theta_direction = m.thetad.sign();
  m.others = apply_to_columns(smooth, r.others);
  if (r.links.cols() == 0) return m;
  Eigen::ArrayXXd links = r.links;
  links.col(r.joint) = r.q;  // as a sensor's error may have changed it
  m.links = apply_to_columns(smooth, links);
  m.links_d = apply_to_columns(slope, links);
  if (of_arm) m.links_dd = apply_to_columns(curvature, links);
  return m;
}

Eigen::ArrayXd smooth_torque(const Recording& r, double late, const Smoothing& smoothing,
                             Eigen::Index every) {
  Eigen::ArrayXd tau = r.tau;
  if (late > 0)
    for (Eigen::Index i = tau.size() - 1; i > 0; --i)
      tau(i) = (1 - late) * tau(i) + late * tau(i - 1);
  const Kernel kernel = gaussian(smoothing.signals, r.period);
  if (every == 1) return apply(kernel, tau);
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero((tau.size() + every - 1) / every);
  const Eigen::Index reach = kernel.reach(), first = (reach + every - 1) / every;
  for (Eigen::Index i = first; i * every + reach < tau.size(); ++i)
    out(i) = (kernel.weights * tau.segment(i * every - reach, 2 * reach + 1)).sum();
  return out;
}

std::vector<Eigen::Index> moving_rows(const Eigen::ArrayXd& speed, double least_speed,
                                      double period, const Smoothing& smoothing) {
  const Eigen::Index reach = gaussian(smoothing.columns, period).reach();
  const Eigen::Index margin = reach + gaussian(smoothing.signals, period).reach();
  const Eigen::Index edge = (margin / smoothing.stride + 2) * smoothing.stride;
  const Eigen::Index n = speed.size();
  std::vector<Eigen::Index> rows;
  Eigen::Index last_slow = -1;
  Eigen::Index seen = 0;
  for (Eigen::Index i = edge; i + edge < n; i += smoothing.stride) {
    for (seen = std::max(seen, i - reach); seen <= i + reach; ++seen) {
      const bool turns = seen > 0 && speed(seen) * speed(seen - 1) < 0;
      if (turns || std::abs(speed(seen)) < least_speed) last_slow = seen;
    }
    if (last_slow < i - reach) rows.push_back(i);
  }
  return rows;
}

/// What cables lose on the pulleys that they pass. It turns within the rows, with the motion of
/// other joints, and so it is smoothed like the measured torques.
void fill_path_friction(const SmoothMotion& m, const Model& model, const Smoothing& smoothing,
                        std::vector<JointState>& states) {
  if (model.whole == nullptr || m.links.cols() == 0) return;
  PathFriction path(passing_cables(model), 0);
  if (path.is_empty()) return;
  const Transmission& own = model.transmission;
  std::vector<JointSignals> joint(1);
  joint.front().q = m.q;
  joint.front().theta = m.theta;
  Eigen::ArrayXXd tension(own.cables.size(), m.size());  // side by side, as one sample needs them
  for (std::size_t i = 0; i < own.cables.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    Eigen::ArrayXd l = elongation(own, own.cables[i], joint);
    if (m.others.cols() > 0) l += m.others.col(k);
    tension.row(k) = l.unaryExpr([&](double x) { return own.cables[i].force(x); }).transpose();
  }
  const Eigen::ArrayXXd q = m.links.transpose(), qd = m.links_d.transpose();
  const auto at = [](const Eigen::ArrayXXd& table, Eigen::Index i) {
    return std::span<const double>(table.col(i).data(), static_cast<std::size_t>(table.rows()));
  };
  const auto at_own = static_cast<std::size_t>(own_place(model));
  Eigen::ArrayXd torque(m.size());
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    path.advance(at(q, i), at(qd, i), m.period);
    torque(i) = path.on_link(at_own, at(q, i), at(tension, i));
  }
  torque = apply(gaussian(suited(smoothing, m.period).signals, m.period), torque);
  for (Eigen::Index i = 0; i < m.size(); ++i)
    states[static_cast<std::size_t>(i)].path_friction = torque(i);
}

std::vector<JointState> joint_states(const SmoothMotion& m, const Model& model,
                                     const Smoothing& smoothing) {
  std::vector<JointState> states(static_cast<std::size_t>(m.size()));
  const double zero = model.rigid ? 0 : model.transmission.encoder_zero()(0);
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    JointState& s = states[static_cast<std::size_t>(i)];
    s.t = m.t0 + static_cast<double>(i) * m.period;
    s.q = m.q(i);
    s.qd = m.qd(i);
    s.qdd = m.qdd(i);
    s.theta = m.theta(i);
    s.thetad = m.thetad(i);
    s.thetadd = m.thetadd(i);
    s.deflection = s.theta - zero - s.q;
    s.deflection_rate = s.thetad - s.qd;
  }
  if (model.rigid) {
    for (Eigen::Index i = 0; i < m.size(); ++i) {
      JointState& s = states[static_cast<std::size_t>(i)];
      s.load = m.tau_load(i);
      s.tau_elas = -s.load;
    }
    return states;
  }
  constexpr double kProbe = 1e-6;  // rad; curves bend over mrad
  const ElasticTorque tau = elastic_torque(model.transmission, m, 0);
  const ElasticTorque more = elastic_torque(model.transmission, m, kProbe);
  const ElasticTorque less = elastic_torque(model.transmission, m, -kProbe);
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    JointState& s = states[static_cast<std::size_t>(i)];
    s.tau_elas = tau.sum(i);
    s.tension = tau.amounts(i);
    s.stiffness = (more.sum(i) - less.sum(i)) / (2 * kProbe);
  }
  fill_path_friction(m, model, smoothing, states);
  return states;
}

double most_of(std::vector<double> values) {
  if (values.empty()) return 0;
  constexpr double kMost = 0.99;
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(kMost * last);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace cablefit
