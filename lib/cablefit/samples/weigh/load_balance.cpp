#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kOddBalance = 1.4, kWrongBalance = 1.8;  // ratio to what balances the load
constexpr double kFollowsLoad = 0.95;                     // correlation beside inertia and friction
constexpr double kFollowsClosely = 0.97;                  // for a ratio that is only odd
constexpr double kBrakes = 0.5;                           // of the power that the load exchanges
constexpr double kOwnShare = 0.3;   // of the load's variation that is not the motion's
constexpr double kVaries = 0.1;     // of the largest load: an offset does not pass for it
constexpr double kLeastLoad = 0.1;  // of the motion's torque: an offset would do for a smaller one
constexpr double kNoOffset = 0.5;   // of the motion's torque
constexpr double kStandsOut = 3;    // a constant torque, in rms of what remains beside it
constexpr double kGravity = 9.80665, kSameFactor = 0.02;  // N per kg
constexpr double kUnitMatch = 0.15, kConstant = 1e-3;
constexpr Eigen::Index kFewBalanced = 40;

using PartList = std::vector<const CoarsePart*>;

/// Columns [1, acceleration, speed, direction] of the motion, load and tau, of all parts.
struct BalanceRows {
  Eigen::MatrixXd motion;
  Eigen::VectorXd load, tau;
};

BalanceRows balance_rows(const PartList& parts) {
  Eigen::Index n = 0;
  for (const CoarsePart* part : parts) n += static_cast<Eigen::Index>(part->inner.size());
  BalanceRows rows{Eigen::MatrixXd(n, 4), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  Eigen::Index at = 0;
  for (const CoarsePart* part : parts) {
    const CoarsePart::Joint& joint = part->joints.front();
    const CoarseRates motion = coarse_rates(*part, joint.theta.size() > 0 ? joint.theta : joint.q);
    const auto m = static_cast<Eigen::Index>(part->inner.size());
    auto block = rows.motion.middleRows(at, m);
    block.col(0).setOnes();
    block.col(1) = motion.second.matrix();
    block.col(2) = motion.first.matrix();
    block.col(3) = motion.first.sign().matrix();
    rows.load.segment(at, m) = at_inner(*part, joint.load).matrix();
    rows.tau.segment(at, m) = at_inner(*part, joint.tau).matrix();
    at += m;
  }
  return rows;
}

/// The columns in units of their size, so that none is taken for zero.
Eigen::MatrixXd scaled_columns(const Eigen::MatrixXd& columns, Eigen::VectorXd& scale) {
  scale = columns.colwise().norm();
  scale = (scale.array() > 0).select(scale, 1);
  return columns * scale.cwiseInverse().asDiagonal();
}

double rms(const Eigen::VectorXd& x) {
  return x.size() == 0 ? 0 : x.norm() / std::sqrt(static_cast<double>(x.size()));
}

bool is_usual(double ratio) { return ratio > 1 / kWrongBalance && ratio < kWrongBalance; }

bool is_close(double ratio) { return ratio > 1 / kOddBalance && ratio < kOddBalance; }

struct Balance {
  double ratio = 0;  // tau over what balances the load
  bool known = false;
  std::optional<double> error = {};  // relative; none: not known, the offset of tau is in it
};

/// A load that always opposes the motion: friction that grows with it looks like a larger load.
bool is_brake(const BalanceRows& rows) {
  const Eigen::ArrayXd power = rows.load.array() * rows.motion.col(2).array();
  return power.sum() < -kBrakes * power.abs().sum();
}

/// By the part of the load that no inertia and friction could pass for. Friction that follows the
/// load, or a load that follows the direction of motion, leaves the scale unknown.
Balance fitted_balance(const BalanceRows& rows) {
  const Eigen::Index n = rows.tau.size();
  if (n < kFewBalanced) return {};
  const Eigen::VectorXd about = rows.load.array() - rows.load.mean();
  if (rms(about) < kVaries * rows.load.cwiseAbs().maxCoeff()) return {};
  if (is_brake(rows)) return {};
  Eigen::VectorXd scale;
  const Eigen::MatrixXd motion = scaled_columns(rows.motion, scale);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motion);
  const Eigen::VectorXd load = rows.load - motion * qr.solve(rows.load);
  const Eigen::VectorXd tau = rows.tau - motion * qr.solve(rows.tau);
  if (load.norm() < kOwnShare * about.norm() || !(tau.norm() > 0)) return {};
  const double correlation = load.dot(tau) / (load.norm() * tau.norm());
  const double ratio = -load.dot(tau) / load.squaredNorm();
  return {ratio, std::abs(correlation) > (is_usual(ratio) ? kFollowsClosely : kFollowsLoad),
          usual_slope_error(correlation)};
}

/// In these columns the constant load is called tau and the torque tau_load.
bool is_swapped(const CoarsePart& part) {
  const CoarsePart::Joint& joint = part.joints.front();
  return coarse_range(joint.tau) < kConstant * joint.tau.abs().maxCoeff() &&
         coarse_range(joint.load) > kVaries * joint.load.abs().maxCoeff();
}

bool is_milli(double ratio) {
  return std::abs(ratio / 1000 - 1) < kUnitMatch || std::abs(ratio * 1000 - 1) < kUnitMatch;
}

/// Of a load that hardly varies, by the constant part of tau: a gross ratio shows in it, beside an
/// offset that is unknown.
Balance constant_balance(const CoarsePart& part) {
  const BalanceRows rows = balance_rows({&part});
  if (rows.tau.size() < kFewBalanced) return {};
  const double load = rows.load.mean();
  const Eigen::VectorXd about = rows.load.array() - load;
  if (rms(about) > kVaries * std::abs(load)) return {};
  Eigen::VectorXd scale;
  const Eigen::MatrixXd motion = scaled_columns(rows.motion, scale);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motion);
  const Eigen::VectorXd x = qr.solve(rows.tau);
  const double constant = x(0) / scale(0);
  const double remains = rms(rows.tau - motion * x);
  const double of_motion = rms(rows.tau.array() - constant);
  Balance balance;
  balance.ratio = load == 0 ? 0 : -constant / load;
  // What the load leaves of the constant torque has to be more than an offset is.
  const bool counts = (std::abs(load) > kLeastLoad * of_motion &&
                       std::abs(constant + load) > kNoOffset * of_motion) ||
                      is_close(balance.ratio) || is_milli(balance.ratio);
  balance.known = counts && std::abs(constant) > kStandsOut * remains;
  return balance;
}

Finding balance_finding(const LogPlan& plan, std::size_t log, const Balance& balance) {
  const double ratio = balance.ratio;
  const double size = std::abs(ratio);
  if (ratio < 0 && size < kOddBalance && size > 1 / kOddBalance)
    return {log,
            {},
            true,
            "tau_load is reversed: tau acts in the same direction as the load",
            plan.find(Channel::tau_load) >= 0 ? mending_line(plan, Channel::tau_load, 0, -1)
                                              : "change the sign of the load in the rig file"};
  const std::string what =
      fmt::format("tau is {:.3g} times the torque that balances the known load", ratio);
  if (is_milli(ratio)) {
    const Channel channel = ratio > 1 ? Channel::tau : Channel::tau_load;
    return {log,
            {},
            true,
            fmt::format("{}: {} in mN m?", what, channel_name(channel)),
            mending_unit(plan, channel, 0, "mN m")};
  }
  if (std::abs(ratio / kGravity - 1) < kSameFactor)
    return {log,
            {},
            true,
            what + ": the load in kg m?",
            plan.find(Channel::tau_load) >= 0 ? mending_line(plan, Channel::tau_load, 0, kGravity)
                                              : "correct the load in the rig file"};
  const bool wrong = ratio < 0 || size > kWrongBalance || size < 1 / kWrongBalance;
  return {log,
          {},
          wrong,
          what,
          measured_line(plan, Channel::tau, 0, 1 / ratio, balance.error,
                        "factor (torque constant, reduction)")};
}

/// Logs of several whose torque or load is read otherwise than the others'.
Findings odd_ones_out(const Logs& logs, const PartList& parts) {
  Findings findings;
  bool any_usual = false;
  for (const CoarsePart* part : parts) {
    const Balance balance = constant_balance(*part);
    if (!balance.known) continue;
    any_usual = any_usual || is_usual(balance.ratio);
    if (!is_usual(balance.ratio))
      findings.push_back(balance_finding(logs.plan(*part), part->log, balance));
  }
  return any_usual ? findings : Findings{};
}

Findings weigh_group(const Logs& logs, const PartList& parts) {
  const CoarsePart& first = *parts.front();
  if (is_swapped(first))
    return {{first.log,
             {},
             true,
             "tau is constant while the joint moves and tau_load varies: are they swapped?",
             "exchange their columns in the rig file"}};
  if (Findings odd = odd_ones_out(logs, parts); !odd.empty()) return odd;
  Balance balance = fitted_balance(balance_rows(parts));
  if (!balance.known) balance = constant_balance(first);
  if (!balance.known || is_close(balance.ratio)) return {};
  Finding finding = balance_finding(logs.plan(first), first.log, balance);
  finding.whole_rig = true;
  return {finding};
}

}  // namespace

Findings load_balance(const Logs& logs) {
  std::map<std::string, PartList> groups;  // by rig and preload
  for (const CoarsePart& part : logs.parts) {
    const LogPlan& plan = logs.plan(part);
    const CoarsePart::Joint& joint = part.joints.front();
    const bool moves = logs.survey(part).phase == Phase::moving && plan.rig.n_joints() == 1;
    if (!moves || joint.tau.size() == 0 || joint.load.size() == 0) continue;
    if (joint.theta.size() == 0 && joint.q.size() == 0) continue;
    groups[plan.rig.path + '\n' + logs.survey(part).preload].push_back(&part);
  }
  Findings findings;
  for (const auto& [key, parts] : groups) {
    const Findings found = weigh_group(logs, parts);
    findings.insert(findings.end(), found.begin(), found.end());
  }
  return findings;
}

}  // namespace cablefit::weighing
