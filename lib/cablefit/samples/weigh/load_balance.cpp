#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kLeastShare = 0.3;                       // of tau's rms: a load that large shows
constexpr double kOddBalance = 1.4, kWrongBalance = 1.8;  // ratio to what balances the load
constexpr double kKnownTo = 0.1;                          // relative sd of the ratio
constexpr double kUnitMatch = 0.15, kConstant = 1e-3;
constexpr double kVaries = 0.1;  // of the largest load: an offset does not pass for it
constexpr Eigen::Index kFewBalanced = 40;

using PartList = std::vector<const CoarsePart*>;

/// Columns [load, acceleration, speed, direction, 1] and tau, of all parts.
struct BalanceRows {
  Eigen::MatrixXd columns;
  Eigen::VectorXd tau;
};

BalanceRows balance_rows(const PartList& parts) {
  Eigen::Index n = 0;
  for (const CoarsePart* part : parts) n += static_cast<Eigen::Index>(part->inner.size());
  BalanceRows rows{Eigen::MatrixXd(n, 5), Eigen::VectorXd(n)};
  Eigen::Index at = 0;
  for (const CoarsePart* part : parts) {
    const CoarsePart::Joint& joint = part->joints.front();
    const CoarseRates motion = coarse_rates(*part, joint.theta.size() > 0 ? joint.theta : joint.q);
    const auto m = static_cast<Eigen::Index>(part->inner.size());
    auto block = rows.columns.middleRows(at, m);
    block.col(0) = at_inner(*part, joint.load).matrix();
    block.col(1) = motion.second.matrix();
    block.col(2) = motion.first.matrix();
    block.col(3) = motion.first.sign().matrix();
    block.col(4).setOnes();
    rows.tau.segment(at, m) = at_inner(*part, joint.tau).matrix();
    at += m;
  }
  return rows;
}

struct Balance {
  double ratio = 0;  // tau over what balances the load
  bool known = false;
};

Balance fitted_balance(const BalanceRows& rows) {
  const Eigen::Index n = rows.tau.size();
  if (n < kFewBalanced) return {};
  const Eigen::ArrayXd load = rows.columns.col(0).array();
  if (coarse_range(load) < kVaries * load.abs().maxCoeff()) return {};
  const Eigen::VectorXd scale = rows.columns.colwise().norm();
  if ((scale.array() <= 0).any()) return {};
  const Eigen::MatrixXd scaled = rows.columns * scale.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  if (qr.rank() < scaled.cols()) return {};
  const Eigen::VectorXd x = qr.solve(rows.tau);
  const double variance = (rows.tau - scaled * x).squaredNorm() / static_cast<double>(n / 10);
  const Eigen::MatrixXd inverse =
      (scaled.transpose() * scaled)
          .ldlt()
          .solve(Eigen::MatrixXd::Identity(scaled.cols(), scaled.cols()));
  Balance balance;
  balance.ratio = -x(0) / scale(0);
  const double sd = std::sqrt(variance * inverse(0, 0)) / scale(0);
  balance.known = std::abs(balance.ratio) > 0 && sd < kKnownTo * std::abs(balance.ratio);
  return balance;
}

/// In these columns the constant load is called tau and the torque tau_load.
bool is_swapped(const CoarsePart& part) {
  const CoarsePart::Joint& joint = part.joints.front();
  return coarse_range(joint.tau) < kConstant * joint.tau.abs().maxCoeff() &&
         coarse_range(joint.load) > kVaries * joint.load.abs().maxCoeff();
}

bool has_load(const CoarsePart& part) {
  const CoarsePart::Joint& joint = part.joints.front();
  if (joint.tau.size() == 0 || joint.load.size() == 0) return false;
  const double load = std::sqrt(joint.load.square().mean());
  return load > kLeastShare * std::sqrt(joint.tau.square().mean());
}

bool is_milli(double ratio) {
  return std::abs(ratio / 1000 - 1) < kUnitMatch || std::abs(ratio * 1000 - 1) < kUnitMatch;
}

/// Where a constant load stands beside an unknown offset, only a gross ratio shows.
Balance mean_balance(const CoarsePart& part) {
  const CoarsePart::Joint& joint = part.joints.front();
  const double load = joint.load.mean();
  const Eigen::ArrayXd about = joint.tau - joint.tau.mean();
  Balance balance;
  balance.ratio = load == 0 ? 0 : -joint.tau.mean() / load;
  balance.known = std::abs(load) > std::sqrt(about.square().mean()) || is_milli(balance.ratio);
  return balance;
}

Finding balance_finding(const LogPlan& plan, std::size_t log, double ratio) {
  const double size = std::abs(ratio);
  if (ratio < 0 && size < kOddBalance && size > 1 / kOddBalance)
    return {log, 0, true, "tau_load is turned round: tau acts in the same direction as the load",
            plan.find(Channel::tau_load) >= 0 ? mending_line(plan, Channel::tau_load, 0, -1)
                                              : "change the sign of the load in the rig file"};
  const std::string what = fmt::format("tau is {:.3g} times what balances the known load", ratio);
  if (is_milli(ratio)) {
    const Channel channel = ratio > 1 ? Channel::tau : Channel::tau_load;
    return {log, 0, true, fmt::format("{}: {} in mN m?", what, channel_name(channel)),
            mending_unit(plan, channel, 0, "mN m")};
  }
  const bool wrong = ratio < 0 || size > kWrongBalance || size < 1 / kWrongBalance;
  return {log, 0, wrong, what, mending_line(plan, Channel::tau, 0, 1 / ratio)};
}

/// One log of several whose unit is another.
std::optional<Finding> other_unit(const Logs& logs, const PartList& parts) {
  const CoarsePart* other = nullptr;
  bool any_usual = false;
  for (const CoarsePart* part : parts) {
    const double ratio = mean_balance(*part).ratio;
    if (is_milli(ratio)) other = part;
    any_usual = any_usual || (ratio > 1 / kWrongBalance && ratio < kWrongBalance);
  }
  if (other == nullptr || !any_usual) return std::nullopt;
  return balance_finding(logs.plan(*other), other->log, mean_balance(*other).ratio);
}

std::optional<Finding> weigh_group(const Logs& logs, const PartList& parts) {
  const CoarsePart& first = *parts.front();
  if (is_swapped(first))
    return Finding{first.log, 0, true,
                   "tau is constant while the joint moves and tau_load varies: are they swapped?",
                   "exchange their columns in the rig file"};
  if (const auto finding = other_unit(logs, parts)) return finding;
  const bool any_load =
      std::any_of(parts.begin(), parts.end(), [](auto* part) { return has_load(*part); });
  Balance balance;
  if (any_load) balance = fitted_balance(balance_rows(parts));
  if (!balance.known && parts.size() == 1 && (any_load || is_milli(mean_balance(first).ratio)))
    balance = mean_balance(first);
  const double size = std::abs(balance.ratio);
  if (!balance.known) return std::nullopt;
  if (balance.ratio > 0 && size < kOddBalance && size > 1 / kOddBalance) return std::nullopt;
  return balance_finding(logs.plan(first), first.log, balance.ratio);
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
    if (const auto finding = weigh_group(logs, parts)) findings.push_back(*finding);
  }
  return findings;
}

}  // namespace cablefit::weighing
