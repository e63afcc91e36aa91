#include "cablefit/refine/rig_errors/radius_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/search/golden.hpp"

namespace cablefit {
namespace {

constexpr double kFirstStep = 0.005;  // of the cable's largest radius
constexpr int kMostDoublings = 9;     // to over twice the largest radius
constexpr std::size_t kLookedAt = 4;  // pulleys that are fitted, of those that promise most
constexpr double kLeastOwn = 1e-10;   // of the squares of columns; less is rounding

/// How much the squared residual falls, as far as a few radii show.
struct Promise {
  Pulley pulley;
  double from = 0, step = 0;  ///< m, changes of the radius: the minimum is from `from` on, in steps
  double fall = 0;
  double given = 0;  ///< squared residual with the given radius
};

std::optional<double> sum_at(const RadiusFit& fit, const RadiusChanges& changes) {
  const auto errors = fit.errors(changes, false);
  if (!errors) return {};
  return errors->sum();
}

/// Near the given radius, by a parabola. It must be narrow: a cable that is too long and one that
/// is too short do not leave the same residual. `given`: squared residual with the given radius.
std::optional<Promise> near_promise(const RadiusFit& fit, const Pulley& pulley, double given,
                                    double h) {
  constexpr int kTimes = 4;
  constexpr double kNarrower = 0.2;
  for (int i = 0; i < kTimes; ++i, h *= kNarrower) {
    const auto less = sum_at(fit, {{pulley, -h}}), more = sum_at(fit, {{pulley, h}});
    if (!less || !more) return {};
    const double slope = (*more - *less) / 2;
    const double least = std::min(*less, *more);
    if (least > given && i + 1 < kTimes) continue;
    const double bend = *more - 2 * given + *less;
    const double fall = bend > 0 ? slope * slope / (2 * bend) : given - least;
    return Promise{pulley, 0, slope > 0 ? -h : h, fall, given};
  }
  return {};
}

/// Of a pulley that the rig file does not have, among radii up to more than the largest one of its
/// cable: too far for a parabola.
std::optional<Promise> far_promise(const RadiusFit& fit, const Pulley& pulley, double given,
                                   double largest) {
  constexpr int kSteps = 6;
  constexpr double kStep = 0.2;
  Promise best{pulley, 0, 0, 0, given};
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double change = i * kStep * largest;
    const auto sum = sum_at(fit, {{pulley, change}});
    if (!sum || !(given - *sum > best.fall)) continue;
    best.fall = given - *sum;
    best.from = (std::abs(i) - 1) * kStep * (i < 0 ? -largest : largest);
    best.step = change - best.from;
  }
  if (best.step == 0) return {};
  return best;
}

std::optional<Promise> promise_of(const RadiusFit& fit, const Pulley& pulley) {
  const double largest = largest_radius(fit.model().transmission.cables[pulley.cable]);
  const auto given = sum_at(fit, {{pulley, 0}});
  if (!given) return {};
  const auto near = near_promise(fit, pulley, *given, kFirstStep * largest);
  if (radius_of(fit.model().transmission, pulley) != 0) return near;
  const auto far = far_promise(fit, pulley, *given, largest);
  return far && (!near || far->fall > near->fall) ? far : near;
}

std::vector<Promise> most_promising(const RadiusFit& fit, const std::vector<Pulley>& pulleys) {
  std::vector<Promise> all;
  for (const Pulley& pulley : pulleys)
    if (const auto promise = promise_of(fit, pulley)) all.push_back(*promise);
  std::stable_sort(all.begin(), all.end(),
                   [](const Promise& a, const Promise& b) { return a.fall > b.fall; });
  return all;
}

/// Where the residual of one radius is least.
double least_along(const RadiusFit& fit, const Promise& promise) {
  const auto at_change = [&](double change) {
    return sum_at(fit, {{promise.pulley, change}}).value_or(kUnbounded);
  };
  double before = promise.from, at = promise.from + promise.step, least = at_change(at);
  double beyond = at + promise.step;
  for (int i = 0; i < kMostDoublings; ++i) {
    const double next = at_change(beyond);
    if (!(next < least)) break;
    least = next;
    before = at;
    at = beyond;
    beyond = at + 2 * (at - before);
  }
  double low = before, high = beyond;
  for (int i = 0; i < 2; ++i) {  // the golden section is exact to 1 % of its range
    const double found = golden(low, high, at_change);
    const double width = 0.05 * std::abs(high - low);
    low = found - width;
    high = found + width;
  }
  return (low + high) / 2;
}

std::vector<Pulley> pulleys_in(const RadiusChanges& changes) {
  std::vector<Pulley> pulleys;
  for (const RadiusChange& change : changes) pulleys.push_back(change.pulley);
  return pulleys;
}

RadiusChanges moved(RadiusChanges changes, const Eigen::VectorXd& by) {
  for (std::size_t k = 0; k < changes.size(); ++k)
    changes[k].by += by(static_cast<Eigen::Index>(k));
  return changes;
}

bool is_within(const CommonStep& step, double n_sd) {
  return (step.change.array().abs() <= n_sd * step.covariance.diagonal().array().sqrt()).all();
}

/// `near`: the step that is left.
std::optional<FittedRadii> at_minimum(const RadiusFit& fit, const RadiusChanges& changes,
                                      std::optional<CommonStep> near) {
  const auto given = sum_at(fit, unchanged(changes));
  auto errors = fit.errors(changes, true);
  if (!given || !near || !errors) return {};
  return FittedRadii{changes, *std::move(near), *std::move(errors), *given};
}

void sort_by_fall(std::vector<FittedRadii>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](const FittedRadii& a, const FittedRadii& b) { return a.fall() > b.fall(); });
}

/// Sets of radii with the fall that each promises, to first order.
class Promises {
 public:
  /// `slopes`: of the radii of `from`, with these changes.
  Promises(const RadiusFit& fit, const CommonColumns& slopes, const RadiusChanges& from)
      : fit_(fit), slopes_(slopes), from_(from) {}

  void add(const std::vector<Eigen::Index>& which) {
    const auto step = slopes_.step(which, kLeastOwn);
    if (!step) return;
    for (std::size_t k = 0; k < which.size(); ++k) {
      const RadiusChange& own = from_[static_cast<std::size_t>(which[k])];
      const Cable& cable = fit_.model().transmission.cables[own.pulley.cable];
      if (std::abs(step->change(static_cast<Eigen::Index>(k))) > largest_radius(cable)) return;
    }
    sets_.emplace_back(step->fall, which);
  }

  /// The best of them, fitted.
  std::vector<FittedRadii> fitted() {
    std::stable_sort(sets_.begin(), sets_.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    sets_.resize(std::min(kLookedAt, sets_.size()));
    std::vector<FittedRadii> all;
    for (const auto& [fall, which] : sets_) {
      RadiusChanges changes;
      for (const Eigen::Index k : which) changes.push_back(from_[static_cast<std::size_t>(k)]);
      if (auto radii = fitted_radii(fit_, std::move(changes))) all.push_back(*std::move(radii));
    }
    sort_by_fall(all);
    return all;
  }

 private:
  const RadiusFit& fit_;
  const CommonColumns& slopes_;
  const RadiusChanges& from_;
  std::vector<std::pair<double, std::vector<Eigen::Index>>> sets_;
};

}  // namespace

double FittedRadii::sd(std::size_t k) const {
  const auto at = static_cast<Eigen::Index>(k);
  return std::sqrt(std::max(0.0, near.covariance(at, at)));
}

double FittedRadii::dof(std::size_t k) const {
  return near.n_blocks(static_cast<Eigen::Index>(k)) - static_cast<double>(changes.size());
}

RadiusChanges unchanged(RadiusChanges radii) {
  for (RadiusChange& radius : radii) radius.by = 0;
  return radii;
}

std::optional<CommonStep> step_of(const RadiusFit& fit, const RadiusChanges& changes) {
  const auto slopes = fit.slopes(changes, pulleys_in(changes));
  if (!slopes) return {};
  std::vector<Eigen::Index> all(changes.size());
  std::iota(all.begin(), all.end(), 0);
  return slopes->step(all, kLeastOwn);
}

std::vector<FittedRadii> single_radii(const RadiusFit& fit, const std::vector<Pulley>& pulleys) {
  const std::vector<Promise> promises = most_promising(fit, pulleys);
  std::vector<FittedRadii> found;
  for (std::size_t k = 0; k < std::min(kLookedAt, promises.size()); ++k) {
    const RadiusChanges least{{promises[k].pulley, least_along(fit, promises[k])}};
    if (auto one = at_minimum(fit, least, step_of(fit, least))) found.push_back(*std::move(one));
  }
  sort_by_fall(found);
  return found;
}

std::optional<FittedRadii> fitted_radii(const RadiusFit& fit, RadiusChanges changes) {
  constexpr int kSteps = 20;
  constexpr double kShorter = 0.5, kShortest = 0.01;
  constexpr double kNearSd = 0.05, kMostSd = 1;  // of each radius
  auto least = sum_at(fit, changes);
  auto step = step_of(fit, changes);
  for (int i = 0; i < kSteps && least && step && !is_within(*step, kNearSd); ++i) {
    std::optional<double> sum;
    RadiusChanges next;
    for (double part = 1; part > kShortest && !(sum && *sum < *least); part *= kShorter) {
      next = moved(changes, part * step->change);
      sum = sum_at(fit, next);
    }
    if (!sum || !(*sum < *least)) break;
    changes = std::move(next);
    least = sum;
    step = step_of(fit, changes);
  }
  if (!step || !is_within(*step, kMostSd)) return {};
  return at_minimum(fit, changes, std::move(step));
}

std::vector<FittedRadii> with_one_more(const RadiusFit& fit, const FittedRadii& radii,
                                       const std::vector<Pulley>& pulleys) {
  const std::vector<Pulley> own = pulleys_in(radii.changes);
  RadiusChanges all = radii.changes;
  for (const Pulley& pulley : pulleys)
    if (std::find(own.begin(), own.end(), pulley) == own.end()) all.push_back({pulley, 0});
  const auto slopes = fit.slopes(radii.changes, pulleys_in(all));
  if (!slopes) return {};
  Promises promises(fit, *slopes, all);
  std::vector<Eigen::Index> which(own.size() + 1);
  std::iota(which.begin(), which.end(), 0);
  for (std::size_t k = own.size(); k < all.size(); ++k) {
    which.back() = static_cast<Eigen::Index>(k);
    promises.add(which);
  }
  return promises.fitted();
}

std::vector<FittedRadii> radius_pairs(const RadiusFit& fit, const std::vector<Pulley>& pulleys) {
  const auto slopes = fit.slopes({}, pulleys);
  if (!slopes) return {};
  RadiusChanges none;
  for (const Pulley& pulley : pulleys) none.push_back({pulley, 0});
  Promises promises(fit, *slopes, none);
  const auto n = static_cast<Eigen::Index>(pulleys.size());
  for (Eigen::Index one = 0; one < n; ++one)
    for (Eigen::Index other = one + 1; other < n; ++other) promises.add({one, other});
  return promises.fitted();
}

bool is_as_good(const FittedRadii& one, const FittedRadii& best, double fall_before) {
  constexpr double kSameSd = 2, kSameShare = 0.02;
  if (one.errors.joints != best.errors.joints) return false;
  const Paired difference = paired(one.errors.held_out, best.errors.held_out);
  return difference.in_sd() < kSameSd || difference.sum < kSameShare * (best.fall() - fall_before);
}

}  // namespace cablefit
