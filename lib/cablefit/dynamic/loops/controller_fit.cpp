#include "cablefit/dynamic/loops/controller_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {
namespace {

/// Columns of the law, in this order; the response is behind them.
enum Column : Eigen::Index {
  kError,
  kRate,
  kIntegral,
  kPosition,
  kVelocity,
  kAcceleration,
  kColumns
};

constexpr double kMostResidual = 0.5;  // of the torque, rms: a law that leaves more fits its noise
constexpr std::array<double, 3> kLags = {0, 0.5, 1};  // rows from command to torque

/// A law by the columns that it has; simple ones first.
struct Law {
  const char* type;
  std::vector<Eigen::Index> columns;
};
const std::array<Law, 6> kLaws = {{
    {"pd", {kError, kRate}},
    {"pid", {kError, kRate, kVelocity}},  // speed fed back alone, or fed forward
    {"pid", {kError, kRate, kIntegral}},
    {"pid", {kError, kRate, kVelocity, kAcceleration}},
    {"pid", {kError, kRate, kIntegral, kVelocity, kAcceleration}},
    {"pid", {kError, kRate, kIntegral, kPosition, kVelocity, kAcceleration}},
}};

/// Rows of one stretch, the last column the torque; each column about its mean, so that an offset
/// and what an integral began with do not matter.
Eigen::MatrixXd law_rows(const LogPlan& plan, const CopyStretch& stretch, int joint, double lag) {
  const auto column = [&](Channel channel) -> Eigen::VectorXd {
    return stretch.measured.col(plan.find(channel, joint));
  };
  const Eigen::VectorXd reference = column(Channel::theta_ref);
  const Eigen::VectorXd error = reference - column(Channel::theta), tau = column(Channel::tau);
  const Eigen::Index n = tau.size() - 3;
  Eigen::MatrixXd all(tau.size(), static_cast<Eigen::Index>(kColumns));
  all.setZero();
  double integral = 0;
  for (Eigen::Index i = 2; i < tau.size(); ++i) {
    const double h = stretch.period;
    all.row(i) << error(i), (error(i) - error(i - 1)) / h, integral, reference(i),
        (reference(i) - reference(i - 1)) / h,
        (reference(i) - 2 * reference(i - 1) + reference(i - 2)) / (h * h);
    integral += h * error(i);
  }
  Eigen::MatrixXd rows(std::max<Eigen::Index>(0, n), kColumns + 1);
  if (n <= 0) return rows;
  rows.leftCols(kColumns) = (1 - lag) * all.bottomRows(n) + lag * all.middleRows(2, n);
  rows.col(kColumns) = tau.tail(n);
  rows.rowwise() -= rows.colwise().mean().eval();
  return rows;
}

bool has_channels(const LogPlan& plan) {
  return plan.has_for_all(Channel::theta_ref) && plan.has_for_all(Channel::theta) &&
         plan.has_for_all(Channel::tau);
}

/// R of all rows of one joint, by lag.
struct LawRows {
  std::array<StreamingQr, kLags.size()> by_lag{StreamingQr(kColumns + 1), StreamingQr(kColumns + 1),
                                               StreamingQr(kColumns + 1)};
  double n = 0, noise = 0;

  double torque() const { return by_lag[0].r().col(kColumns).norm() / std::sqrt(n); }
};

void add_rows(const LogSurvey& log, const CopyStretch& stretch, int joint, LawRows& all) {
  for (std::size_t lag = 0; lag < kLags.size(); ++lag) {
    const Eigen::MatrixXd rows = law_rows(log.plan, stretch, joint, kLags[lag]);
    if (rows.rows() == 0) continue;
    all.by_lag[lag].add(rows);
    if (lag == 0) all.n += static_cast<double>(rows.rows());
  }
  const auto tau = static_cast<std::size_t>(log.plan.find(Channel::tau, joint));
  all.noise = std::max(all.noise, log.parts[stretch.part].channels[tau].noise);
}

/// Of every joint. None where a log lacks a channel, or where there are too few rows.
std::optional<std::vector<LawRows>> rows_of(std::span<const LogSurvey> logs,
                                            const PartFilter& wanted) {
  std::vector<LawRows> joints;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const LogSurvey& log = logs[k];
    if (std::none_of(log.parts.begin(), log.parts.end(), wanted)) continue;
    if (!has_channels(log.plan)) return std::nullopt;
    const auto n_joints = static_cast<std::size_t>(log.plan.rig.n_joints());
    if (!joints.empty() && joints.size() != n_joints) return std::nullopt;
    joints.resize(n_joints);
    for (const CopyStretch& stretch : read_stretches(log, k, wanted))
      for (std::size_t joint = 0; joint < joints.size(); ++joint)
        add_rows(log, stretch, static_cast<int>(joint), joints[joint]);
  }
  if (joints.empty() || !(joints.front().n > 10 * kColumns)) return std::nullopt;
  return joints;
}

double misfit_of(const LawRows& rows, const Eigen::VectorXd& gains) {
  double least = kUnbounded;
  for (const StreamingQr& qr : rows.by_lag)
    least = std::min(least, (qr.r().col(kColumns) - qr.r().leftCols(kColumns) * gains).norm());
  return least / std::sqrt(rows.n);
}

Eigen::VectorXd gains_of(const Controller& c) {
  Eigen::VectorXd gains(static_cast<Eigen::Index>(kColumns));
  gains << c.kp, c.kd, c.ki, c.feed_position, c.feed_velocity, c.feed_acceleration;
  return gains;
}

/// Least squares of one law at its best lag.
std::optional<ControllerFit> fit_law(const LawRows& rows, const Law& law) {
  ControllerFit best;
  best.misfit = kUnbounded;
  for (const StreamingQr& qr : rows.by_lag) {
    Eigen::MatrixXd w = qr.r()(Eigen::all, law.columns);
    Eigen::VectorXd size = w.colwise().norm();
    for (double& s : size) s = s > 0 ? 1 / s : 0;
    w = w * size.asDiagonal();
    const Eigen::VectorXd scaled = w.colPivHouseholderQr().solve(qr.r().col(kColumns));
    Eigen::VectorXd gains = Eigen::VectorXd::Zero(kColumns);
    gains(law.columns) = size.asDiagonal() * scaled;
    const double misfit =
        (qr.r().col(kColumns) - qr.r().leftCols(kColumns) * gains).norm() / std::sqrt(rows.n);
    if (misfit >= best.misfit) continue;
    Controller& c = best.controller;
    c.type = law.type;
    c.kp = gains(kError), c.kd = gains(kRate), c.ki = gains(kIntegral);
    c.feed_position = gains(kPosition), c.feed_velocity = gains(kVelocity);
    c.feed_acceleration = gains(kAcceleration);
    best.misfit = misfit;
  }
  best.torque = rows.torque();
  best.noise = rows.noise;
  const Controller& c = best.controller;
  if (!(c.kp > 0) || !(c.kd >= 0) || !(c.ki >= 0)) return std::nullopt;
  return best;
}

/// The simplest law that explains about as much as the richest.
std::optional<ControllerFit> simplest_fit(const LawRows& rows) {
  const std::optional<ControllerFit> richest = fit_law(rows, kLaws.back());
  std::optional<ControllerFit> best;
  for (const Law& law : kLaws) {
    const std::optional<ControllerFit> fit = fit_law(rows, law);
    if (!fit) continue;
    if (!best || fit->misfit * kSimplerBy < best->misfit) best = fit;
    if (richest && best->misfit <= kSimplerBy * richest->misfit) break;
  }
  return best;
}

}  // namespace

bool ControllerFit::fits() const {
  return misfit * misfit <= kControllerNoise * kControllerNoise * noise * noise +
                                kControllerShare * kControllerShare * torque * torque;
}

std::string ControllerFit::text(Axes axes) const {
  const std::string angle = unit_for(axes, "rad");
  const std::string unit = torque_unit(axes);
  std::string text = fmt::format("kp {:.4g} {}/{}, kd {:.4g} {} s/{}", controller.kp, unit, angle,
                                 controller.kd, unit, angle);
  const auto add = [&](const char* name, double gain, const std::string& of) {
    if (gain != 0) text += fmt::format(", {} {:.4g} {}", name, gain, of);
  };
  add("ki", controller.ki, fmt::format("{}/({} s)", unit, angle));
  add("feedforward position", controller.feed_position, fmt::format("{}/{}", unit, angle));
  add("velocity", controller.feed_velocity, fmt::format("{} s/{}", unit, angle));
  add("acceleration", controller.feed_acceleration, fmt::format("{} s^2/{}", unit, angle));
  text += fmt::format("; its torque is {:.3g} {} rms from the measured one", misfit, unit);
  if (noise > 0) text += fmt::format(", {:.2g} sd of the noise", misfit / noise);
  return text;
}

bool ControllerFits::all_fit() const {
  return std::all_of(joints.begin(), joints.end(),
                     [](const ControllerFit& joint) { return joint.fits(); });
}

Controller ControllerFits::controller() const {
  std::vector<Controller> controllers;
  for (const ControllerFit& joint : joints) controllers.push_back(joint.controller);
  return controller_of(std::move(controllers));
}

std::string ControllerFits::text(const JointAxes& axes, bool only_wrong) const {
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (only_wrong && joints[k].fits()) continue;
    const std::string which = joints.size() > 1 ? fmt::format("joint {}: ", k + 1) : "";
    texts.push_back(which + joints[k].text(axes.of(static_cast<int>(k))));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::optional<ControllerFits> check_controllers(std::span<const LogSurvey> logs,
                                                const PartFilter& wanted) {
  const Controller* controller = nullptr;
  for (const LogSurvey& log : logs)
    if (log.plan.rig.controller && std::any_of(log.parts.begin(), log.parts.end(), wanted))
      controller = &*log.plan.rig.controller;
  if (controller == nullptr) return std::nullopt;
  const std::optional<std::vector<LawRows>> rows = rows_of(logs, wanted);
  if (!rows) return std::nullopt;
  ControllerFits fits;
  for (std::size_t k = 0; k < rows->size(); ++k) {
    const LawRows& joint = (*rows)[k];
    const Controller& own = controller->of(k);
    fits.joints.push_back({own, misfit_of(joint, gains_of(own)), joint.torque(), joint.noise});
  }
  return fits;
}

std::optional<ControllerFits> fit_controllers(std::span<const LogSurvey> logs,
                                              const PartFilter& wanted) {
  const std::optional<std::vector<LawRows>> rows = rows_of(logs, wanted);
  if (!rows) return std::nullopt;
  ControllerFits fits;
  for (const LawRows& joint : *rows) {
    const std::optional<ControllerFit> fit = simplest_fit(joint);
    if (!fit || fit->misfit > kMostResidual * fit->torque) return std::nullopt;
    fits.joints.push_back(*fit);
  }
  return fits;
}

}  // namespace cablefit
