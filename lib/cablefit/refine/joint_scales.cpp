#include "cablefit/refine/joint_scales.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/refine/rows/base_rows.hpp"

namespace cablefit {
namespace {

constexpr double kWellKnown = 0.1;  // sd over value of what is compared
// Relative, of each value: an sd does not contain every error of the method. Known as if from so
// many values, with which the scatter of the values themselves is pooled.
constexpr double kLeastSd = 0.0014;
constexpr double kPriorDof = 10;
constexpr double kLeastScale = 0.02;  // distance of a factor from 1 that matters
constexpr double kLeastExplained = 0.9;
constexpr int kLeastShared = 2;  // one alone differs for many reasons, such as a wrong radius

struct Measured {
  double value = 0, relative_sd = 0;
};

/// What one joint measures of that which several share.
struct Shared {
  std::map<std::string, Measured> by_name;
  double cad_distance = 0;  ///< mean |log| of its masses over those of the rig; 0: there are none
};

void add(const Estimate* e, Shared& shared) {
  if (e == nullptr || !(e->sd > 0) || e->sd > kWellKnown * std::abs(e->value)) return;
  shared.by_name[e->name] = {e->value, std::hypot(kLeastSd, e->sd / e->value)};
}

Shared shared_of(const Model& one) {
  Shared shared;
  double n = 0;
  for (const ModelParameter& p : base_layout(one).parameters) {
    if (p.kind == ParameterKind::coefficient) add(find_estimate(one.elastic, p.name), shared);
    if (p.kind != ParameterKind::arm) continue;
    add(find_estimate(one.arm, p.name), shared);
    const auto cad = one.rig.cad.find(p.name);
    const auto found = shared.by_name.find(p.name);
    if (cad == one.rig.cad.end() || found == shared.by_name.end() ||
        !(found->second.value / cad->second > 0))
      continue;
    shared.cad_distance += std::abs(std::log(found->second.value / cad->second));
    ++n;
  }
  if (n > 0) shared.cad_distance /= n;
  return shared;
}

using Joints = std::vector<std::size_t>;

/// log |value| = log |true value| + log factor of the joint, by weighted least squares.
struct Factors {
  Eigen::VectorXd log_factor;  ///< per free joint
  Eigen::MatrixXd covariance;
  double left = 0;  ///< weighted squared residual
  double dof = 1;
};

/// `named`: the joints with a factor; the others have none.
Factors fitted_factors(const std::vector<Shared>& shared, const Joints& group,
                       const Joints& named) {
  std::map<std::string, Eigen::Index> names;
  for (const std::size_t joint : group)
    for (const auto& [name, measured] : shared[joint].by_name)
      names.emplace(name, static_cast<Eigen::Index>(names.size()));
  Eigen::Index n_rows = 0;
  for (const std::size_t joint : group)
    n_rows += static_cast<Eigen::Index>(shared[joint].by_name.size());
  const auto n_free = static_cast<Eigen::Index>(named.size());
  const Eigen::Index n = n_free + static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n_rows, n);
  Eigen::VectorXd logs(n_rows);
  Eigen::Index row = 0;
  for (const std::size_t joint : group) {
    const auto at = std::find(named.begin(), named.end(), joint);
    for (const auto& [name, measured] : shared[joint].by_name) {
      const double weight = 1 / measured.relative_sd;
      rows(row, n_free + names.at(name)) = weight;
      if (at != named.end()) rows(row, at - named.begin()) = weight;
      logs(row++) = weight * std::log(std::abs(measured.value));
    }
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> qr(rows);
  const Eigen::VectorXd x = qr.solve(logs);
  const Eigen::MatrixXd inverse = qr.pseudoInverse();
  Factors out;
  out.log_factor = x.head(n_free);
  out.left = (rows * x - logs).squaredNorm();
  out.dof = kPriorDof + static_cast<double>(n_rows - qr.rank());
  const double variance = (kPriorDof + out.left) / out.dof;
  out.covariance = variance * (inverse * inverse.transpose()).topLeftCorner(n_free, n_free);
  return out;
}

/// Joints that share something, compared.
class Comparisons {
 public:
  Comparisons(const std::vector<const Model*>& fits, const std::vector<TorqueTrust>& trust,
              double significance)
      : trust_(trust), significance_(significance) {
    for (const Model* one : fits) shared_.push_back(one == nullptr ? Shared{} : shared_of(*one));
  }

  std::vector<JointScale> scales() const {
    std::vector<JointScale> all(shared_.size());
    std::vector<bool> is_done(shared_.size());
    for (std::size_t joint = 0; joint < shared_.size(); ++joint) {
      if (is_done[joint]) continue;
      const Joints group = group_of(joint);
      for (const std::size_t member : group) is_done[member] = true;
      if (group.size() > 1) set_scales(group, all);
    }
    return all;
  }

 private:
  /// With the same sign: of other signs no factor is the cause.
  int n_shared(std::size_t i, std::size_t j) const {
    int n = 0;
    for (const auto& [name, measured] : shared_[i].by_name) {
      const auto other = shared_[j].by_name.find(name);
      if (other == shared_[j].by_name.end()) continue;
      if (!(other->second.value / measured.value > 0)) return 0;
      ++n;
    }
    return n;
  }

  /// Values of the joint that another one of the group has as well.
  int n_compared(std::size_t joint, const Joints& group) const {
    const auto& own = shared_[joint].by_name;
    return static_cast<int>(std::count_if(own.begin(), own.end(), [&](const auto& value) {
      return std::any_of(group.begin(), group.end(), [&](std::size_t other) {
        return other != joint && shared_[other].by_name.contains(value.first);
      });
    }));
  }

  Joints group_of(std::size_t joint) const {
    Joints group{joint};
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::size_t other = 0; other < shared_.size(); ++other)
        if (std::find(group.begin(), group.end(), other) == group.end() &&
            n_shared(group[k], other) >= kLeastShared)
          group.push_back(other);
    return group;
  }

  bool differs(double log_factor, double variance, double dof) const {
    return std::abs(std::expm1(log_factor)) > kLeastScale &&
           t_tail(std::abs(log_factor) / std::sqrt(variance), dof) < significance_;
  }

  /// Of every joint of the group those with the same torque, itself among them.
  std::vector<Joints> agreeing(const Joints& group) const {
    const Joints others(group.begin() + 1, group.end());
    const Factors all = fitted_factors(shared_, group, others);
    const auto n = static_cast<Eigen::Index>(group.size());
    Eigen::VectorXd factor = Eigen::VectorXd::Zero(n);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
    factor.tail(n - 1) = all.log_factor;
    covariance.bottomRightCorner(n - 1, n - 1) = all.covariance;
    std::vector<Joints> agreeing(group.size());
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const double variance = covariance(i, i) + covariance(j, j) - 2 * covariance(i, j);
        if (i == j || !differs(factor(i) - factor(j), variance, all.dof))
          agreeing[static_cast<std::size_t>(i)].push_back(group[static_cast<std::size_t>(j)]);
      }
    return agreeing;
  }

  /// The reference: joints that agree with one whose load confirms its torque, else the largest
  /// group that agrees; of equal groups the one nearest to the masses of the rig file.
  Joints right_ones(const Joints& group) const {
    const std::vector<Joints> all = agreeing(group);
    std::size_t best = 0;
    for (std::size_t k = 1; k < group.size(); ++k) {
      const std::size_t one = group[k], other = group[best];
      if (trust_[one] != trust_[other]) {
        if (trust_[one] > trust_[other]) best = k;
      } else if (all[k].size() != all[best].size()) {
        if (all[k].size() > all[best].size()) best = k;
      } else if (shared_[one].cad_distance < shared_[other].cad_distance) {
        best = k;
      }
    }
    return all[best];
  }

  void set_scales(const Joints& group, std::vector<JointScale>& all) const {
    const Joints right = right_ones(group);
    TorqueTrust best = TorqueTrust::contradicted;
    for (const std::size_t joint : right) best = std::max(best, trust_[joint]);
    for (const std::size_t joint : group) all[joint].comparable = best != TorqueTrust::contradicted;
    Joints off;
    for (const std::size_t joint : group)
      if (std::find(right.begin(), right.end(), joint) == right.end()) off.push_back(joint);
    if (off.empty()) return;
    const Factors with = fitted_factors(shared_, group, off);
    const double explained = 1 - with.left / fitted_factors(shared_, group, {}).left;
    if (!(explained > kLeastExplained)) return;
    for (std::size_t k = 0; k < off.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      const double variance = with.covariance(at, at);
      if (!differs(with.log_factor(at), variance, with.dof)) continue;
      JointScale& scale = all[off[k]];
      scale.scale = std::exp(with.log_factor(at));
      scale.sd = scale.scale * std::sqrt(variance);
      scale.n = n_compared(off[k], group);
      scale.explained = explained;
      scale.dof = with.dof;
      scale.chance = t_tail(std::abs(with.log_factor(at)) / std::sqrt(variance), with.dof);
      if (may_be_right(off[k], right, group, best)) scale.rivals.assign(right.begin(), right.end());
    }
  }

  /// Its own load confirms its torque; or no load confirms the reference, which is no larger group.
  bool may_be_right(std::size_t joint, const Joints& right, const Joints& group,
                    TorqueTrust best) const {
    if (trust_[joint] == TorqueTrust::confirmed) return true;
    return best != TorqueTrust::confirmed && 2 * right.size() <= group.size();
  }

  std::vector<Shared> shared_;
  std::vector<TorqueTrust> trust_;
  double significance_;
};

}  // namespace

std::vector<JointScale> joint_scales(const std::vector<const Model*>& fits,
                                     const std::vector<TorqueTrust>& trust, double significance) {
  return Comparisons(fits, trust, significance).scales();
}

}  // namespace cablefit
