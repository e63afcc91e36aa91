#include "cablefit/copies/fast_motion.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/samples/rows/butterworth.hpp"
#include "cablefit/simulate/coupling.hpp"

namespace cablefit {
namespace {

constexpr double kWidestBand = 0.4;  // of the rate, for the low-pass
constexpr int kFilterOrder = 4;
constexpr double kPart = 1.5;  // upper to lower limit of a part of the band, at most
constexpr double kEdge = 4;    // periods of the highest frequency

/// Central differences.
Eigen::ArrayXd velocity(const Eigen::ArrayXd& x, double period) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(x.size());
  const Eigen::Index n = x.size() - 2;
  if (n > 0) out.segment(1, n) = (x.tail(n) - x.head(n)) / (2 * period);
  return out;
}

Eigen::ArrayXd acceleration(const Eigen::ArrayXd& x, double period) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(x.size());
  const Eigen::Index n = x.size() - 2;
  if (n > 0) out.segment(1, n) = (x.head(n) - 2 * x.segment(1, n) + x.tail(n)) / (period * period);
  return out;
}

/// What the cables do on the motor of a joint where they were measured.
Eigen::VectorXd elastic_torque(const Model& model, const LogPlan& plan,
                               const Eigen::MatrixXd& measured, int joint) {
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(measured.rows());
  if (model.rigid) return torque;
  const Coupling coupling(model.transmission);
  const std::size_t n = model.joints.size();
  std::vector<double> q(n), theta(n), link(n), motor(n);
  std::vector<Pull> cables(coupling.n_cables());
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      q[k] = measured(i, plan.find(Channel::q, static_cast<int>(k)));
      theta[k] = measured(i, plan.find(Channel::theta, static_cast<int>(k)));
    }
    coupling.pull(q.data(), theta.data(), cables.data());
    coupling.torques(q.data(), theta.data(), cables.data(), link.data(), motor.data());
    torque(i) = motor[static_cast<std::size_t>(joint)];
  }
  return torque;
}

/// Inertia and friction of the motor where it moved as `theta` says.
Eigen::VectorXd motor_torque(const std::vector<EffectInstance>& effects,
                             const Eigen::ArrayXd& theta, double period) {
  const Eigen::ArrayXd speed = velocity(theta, period), direction = speed.sign();
  const Eigen::ArrayXd more = acceleration(theta, period);
  return base_torque(effects, {theta, speed, more, direction});
}

/// Share of the squared torque `acted` that is also in `asked`.
double share_of(const Eigen::VectorXd& asked, const Eigen::VectorXd& acted) {
  const double all = acted.squaredNorm();
  return all > 0 ? std::clamp(asked.dot(acted) / all, 0.0, 1.0) : 0;
}

/// A held torque as differences of the motion see it: the mean of the two that act around a row.
Eigen::VectorXd around_rows(const Eigen::VectorXd& tau, bool is_held) {
  Eigen::VectorXd out = tau;
  const Eigen::Index n = tau.size() - 1;
  if (is_held && n > 0) out.tail(n) = 0.5 * (tau.head(n) + tau.tail(n));
  return out;
}

}  // namespace

Eigen::MatrixXd smooth(const Eigen::MatrixXd& columns, double period, double cutoff) {
  Eigen::MatrixXd out = columns;
  if (cutoff > 0 && cutoff < kWidestBand / period)
    Butterworth(kFilterOrder, cutoff, 1 / period).apply(out, true, true);
  return out;
}

FastMotion fast_motion(const Model& model, const LogPlan& plan, const CopyStretch& stretch,
                       int joint, const FrequencyBand& band, bool torque_held) {
  const double period = stretch.period;
  const Eigen::Index n = stretch.measured.rows();
  FastMotion out{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  if (!(band.to > band.from)) return out;
  const Eigen::VectorXd tau = stretch.measured.col(plan.find(Channel::tau, joint));
  const Eigen::VectorXd theta = stretch.measured.col(plan.find(Channel::theta, joint));
  const Eigen::ArrayXd quiet = smooth(theta, period, band.to).array();
  Eigen::MatrixXd columns(n, 4);  // measured, torque around each row, torque that is asked for
  columns << theta, tau, around_rows(tau, torque_held),
      motor_torque(model.joints[static_cast<std::size_t>(joint)].motor, quiet, period) +
          elastic_torque(model, plan, stretch.measured, joint);
  // Filter and differences are wrong at either end. The narrow bands would spread that error.
  const auto edge = std::min(n / 4, static_cast<Eigen::Index>(kEdge / (band.to * period)));
  columns.col(3).head(edge) = columns.col(2).head(edge);
  columns.col(3).tail(edge) = columns.col(2).tail(edge);
  const int parts = static_cast<int>(std::ceil(std::log(band.to / band.from) / std::log(kPart)));
  Eigen::MatrixXd below = smooth(columns, period, band.from);
  for (int part = 1; part <= parts; ++part) {
    const double to = band.from * std::pow(band.to / band.from, static_cast<double>(part) / parts);
    const Eigen::MatrixXd upto = smooth(columns, period, to);
    const Eigen::MatrixXd here = upto - below;
    const double share = share_of(here.col(3), here.col(2));
    out.theta += share * here.col(0);
    out.tau += std::sqrt(share) * here.col(1);
    below = upto;
  }
  return out;
}

}  // namespace cablefit
