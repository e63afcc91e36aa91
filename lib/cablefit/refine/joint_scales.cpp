#include "cablefit/refine/joint_scales.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/refine/rows/base_rows.hpp"

namespace cablefit {
namespace {

constexpr double kWellKnown = 0.1;  // sd over value of what is compared
constexpr double kLeastSd = 0.002;  // of a ratio: an sd does not contain every error of the method
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
  TorqueTrust trust = TorqueTrust::unknown;
};

void add(const Estimate* e, Shared& shared) {
  if (e == nullptr || !(e->sd > 0) || e->sd > kWellKnown * std::abs(e->value)) return;
  shared.by_name[e->name] = {e->value, e->sd / std::abs(e->value)};
}

Shared shared_of(const Model& one) {
  Shared shared;
  double n = 0;
  for (const ModelParameter& p : base_layout(one).parameters) {
    if (p.kind == ParameterKind::coefficient) add(find_estimate(one.elastic, p.name), shared);
    if (p.kind != ParameterKind::arm) continue;
    add(find_estimate(one.arm, p.name), shared);
    const auto cad = one.rig.cad.find(p.name), end = one.rig.cad.end();
    const auto found = shared.by_name.find(p.name);
    if (cad == end || found == shared.by_name.end() || !(found->second.value / cad->second > 0))
      continue;
    shared.cad_distance += std::abs(std::log(found->second.value / cad->second));
    ++n;
  }
  if (n > 0) shared.cad_distance /= n;
  return shared;
}

/// One factor between all that two joints measure: the second's over the first's.
struct Comparison {
  int n = 0;
  double log_ratio = 0, sd = 0, explained = 0, chance = 1;

  bool is_possible() const { return n >= kLeastShared; }
  bool differs(double significance) const {
    return is_possible() && std::abs(log_ratio) > kLeastScale && explained > kLeastExplained &&
           chance < significance;
  }
};

Comparison compared(const Shared& first, const Shared& second) {
  Comparison c;
  double weights = 0, sum = 0, squares = 0;
  for (const auto& [name, a] : first.by_name) {
    const auto other = second.by_name.find(name);
    if (other == second.by_name.end()) continue;
    const double ratio = other->second.value / a.value;
    if (!(ratio > 0)) return {};
    const double x = std::log(ratio);
    const double sd = std::max(kLeastSd, std::hypot(a.relative_sd, other->second.relative_sd));
    weights += 1 / (sd * sd);
    sum += x / (sd * sd);
    squares += x * x / (sd * sd);
    ++c.n;
  }
  if (!c.is_possible()) return c;
  c.log_ratio = sum / weights;
  const double left = std::max(0.0, squares - sum * sum / weights);
  c.explained = squares > 0 ? 1 - left / squares : 0;
  c.sd = std::sqrt(std::max(1.0, left / (c.n - 1)) / weights);
  c.chance = t_tail(std::abs(c.log_ratio) / c.sd, c.n - 1);
  return c;
}

/// Joints that share something, compared.
class Comparisons {
 public:
  Comparisons(const std::vector<const Model*>& fits, const std::vector<TorqueTrust>& trust,
              double significance)
      : significance_(significance) {
    for (std::size_t k = 0; k < fits.size(); ++k) {
      shared_.push_back(fits[k] == nullptr ? Shared{} : shared_of(*fits[k]));
      shared_.back().trust = trust[k];
    }
  }

  /// Per joint; the reference of every group of joints that share something has 1.
  std::vector<JointScale> scales() const {
    std::vector<JointScale> all(shared_.size());
    std::vector<bool> is_done(shared_.size());
    for (std::size_t joint = 0; joint < shared_.size(); ++joint) {
      if (is_done[joint]) continue;
      const std::vector<std::size_t> group = group_of(joint);
      for (const std::size_t member : group) is_done[member] = true;
      set_scales(group, all);
    }
    return all;
  }

 private:
  Comparison between(std::size_t i, std::size_t j) const {
    return compared(shared_[i], shared_[j]);
  }

  std::vector<std::size_t> group_of(std::size_t joint) const {
    std::vector<std::size_t> group{joint};
    for (std::size_t k = 0; k < group.size(); ++k)
      for (std::size_t other = 0; other < shared_.size(); ++other)
        if (std::find(group.begin(), group.end(), other) == group.end() &&
            between(group[k], other).is_possible())
          group.push_back(other);
    return group;
  }

  int n_agreeing(std::size_t joint, const std::vector<std::size_t>& group) const {
    return static_cast<int>(std::count_if(group.begin(), group.end(), [&](std::size_t other) {
      const Comparison c = between(joint, other);
      return other != joint && c.is_possible() && !c.differs(significance_);
    }));
  }

  /// The joint that a load has weighed, else with whose torque most others agree; of several the
  /// one nearest to the masses of the rig file.
  std::size_t reference_of(const std::vector<std::size_t>& group) const {
    return *std::max_element(group.begin(), group.end(), [&](std::size_t a, std::size_t b) {
      if (shared_[a].trust != shared_[b].trust) return shared_[a].trust < shared_[b].trust;
      const int of_a = n_agreeing(a, group), of_b = n_agreeing(b, group);
      if (of_a != of_b) return of_a < of_b;
      return shared_[a].cad_distance > shared_[b].cad_distance;
    });
  }

  /// From joint to joint, the reference first.
  void set_scales(const std::vector<std::size_t>& group, std::vector<JointScale>& all) const {
    std::vector<std::size_t> known{reference_of(group)};
    all[known.front()].compared = group.size() > 1;
    for (std::size_t k = 0; k < known.size(); ++k)
      for (const std::size_t other : group) {
        if (std::find(known.begin(), known.end(), other) != known.end()) continue;
        const Comparison c = between(known[k], other);
        if (!c.is_possible()) continue;
        const JointScale& from = all[known[k]];
        all[other] = from;
        if (c.differs(significance_))
          all[other] = {from.scale * std::exp(c.log_ratio),
                        from.scale * c.sd,
                        true,
                        c.n,
                        c.explained,
                        c.chance,
                        {}};
        known.push_back(other);
      }
    set_rivals(group, all);
  }

  /// Where as many joints are off as not, the others may be the wrong ones, unless a load tells.
  void set_rivals(const std::vector<std::size_t>& group, std::vector<JointScale>& all) const {
    std::vector<int> agreeing;
    bool is_weighed = false;
    for (const std::size_t joint : group)
      if (!all[joint].is_off()) {
        agreeing.push_back(static_cast<int>(joint));
        is_weighed = is_weighed || shared_[joint].trust == TorqueTrust::weighed;
      }
    if (is_weighed || 2 * agreeing.size() > group.size()) return;
    for (const std::size_t joint : group)
      if (all[joint].is_off() && shared_[joint].trust != TorqueTrust::off)
        all[joint].rivals = agreeing;
  }

  std::vector<Shared> shared_;
  double significance_;
};

}  // namespace

std::vector<JointScale> joint_scales(const std::vector<const Model*>& fits,
                                     const std::vector<TorqueTrust>& trust, double significance) {
  return Comparisons(fits, trust, significance).scales();
}

}  // namespace cablefit
