#include "cablefit/refine/rig_errors/wrong_radius.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/refine/rig_errors/radius_search.hpp"

namespace cablefit {
namespace {

// Of the cable's largest radius: errors of smoothed motion, which no scatter over blocks shows.
// 43 simulated fingers and arms had up to 4e-5.
constexpr double kLeastScatter = 2e-5;

const Effect& row_of(const Pulley& pulley) {
  return rig_error_row("cable_radius", site_of(pulley.side));
}

/// "radius[flexor]".
std::string with_cable(std::string_view name, const Pulley& pulley, const Model& model) {
  return fmt::format("{}[{}]", name, model.transmission.cables[pulley.cable].name);
}

/// "cable_radius[flexor]".
std::string name_of(const Pulley& pulley, const Model& model) {
  return with_cable(row_of(pulley).name, pulley, model);
}

struct WrongRadius {
  Pulley pulley;
  double given = 0, radius = 0;     ///< m, signed
  double scatter = 0;               ///< m, sd by the scatter over blocks
  double least_sd = 0;              ///< m, of errors that no scatter shows
  double dof = 1;                   ///< of the t distribution
  double share = 0;                 ///< of the residual of held-out blocks, beside the other radii
  std::vector<Pulley> rivals = {};  ///< whose radius explains the logs as well

  double sd() const { return std::hypot(scatter, least_sd); }
};

/// Radii that were fitted together.
struct WrongRadii {
  std::vector<WrongRadius> all;
  std::size_t n_pulleys = 1;  ///< that were tried

  /// That a radius differs so much where all are right, of as many sets as there are.
  double chance(const WrongRadius& wrong) const {
    double n_sets = 1;
    for (std::size_t k = 0; k < all.size(); ++k)
      n_sets *= static_cast<double>(n_pulleys - k) / static_cast<double>(k + 1);
    return std::min(1.0,
                    n_sets * t_tail(std::abs(wrong.radius - wrong.given) / wrong.sd(), wrong.dof));
  }
  bool are_significant(double significance) const {
    return std::all_of(all.begin(), all.end(), [&](const WrongRadius& wrong) {
      return wrong.scatter > 0 && chance(wrong) < significance;
    });
  }
};

WrongRadii to_wrong_radii(const FittedRadii& fitted, std::size_t n_pulleys, const Model& given) {
  WrongRadii wrong{{}, n_pulleys};
  for (std::size_t k = 0; k < fitted.changes.size(); ++k) {
    const auto& [pulley, by] = fitted.changes[k];
    WrongRadius& one = wrong.all.emplace_back();
    one.pulley = pulley;
    one.given = radius_of(given.transmission, pulley);
    one.radius = one.given + by;
    one.scatter = fitted.sd(k);
    one.least_sd = kLeastScatter * largest_radius(given.transmission.cables[pulley.cable]);
    one.dof = fitted.dof(k);
    one.share = fitted.given > 0 ? fitted.fall() / fitted.given : 0;
  }
  return wrong;
}

RadiusChanges changes_of(const WrongRadii& wrong) {
  RadiusChanges changes;
  for (const WrongRadius& one : wrong.all) changes.push_back({one.pulley, one.radius - one.given});
  return changes;
}

/// Pulleys without those of the errors that were found, and without those whose turn is not known.
std::vector<Pulley> pulleys_left(const RigErrorSearch& search, const RadiusFit& fit) {
  const Model& model = fit.model();
  std::vector<Pulley> pulleys = pulleys_of(model);
  std::erase_if(pulleys, [&](const Pulley& pulley) {
    return search.has(name_of(pulley, model), site_of(pulley.side), pulley.joint) ||
           !fit.knows(pulley);
  });
  return pulleys;
}

/// The radii with another pulley in the place of one of them.
struct Exchange {
  double fall_before = 0;  ///< without that one
  std::vector<FittedRadii> best;
};

/// Nothing where the others are not determined without it.
std::optional<Exchange> exchange(const RadiusFit& fit, const FittedRadii& radii, std::size_t k,
                                 std::vector<Pulley> pulleys) {
  std::erase(pulleys, radii.changes[k].pulley);
  RadiusChanges without = radii.changes;
  without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
  const auto rest = fitted_radii(fit, std::move(without));
  if (!rest) return {};
  return Exchange{rest->fall(), with_one_more(fit, *rest, pulleys)};
}

/// The radii, or others that are better: the best one alone need not be one of the best two.
FittedRadii exchanged(const RadiusFit& fit, FittedRadii radii, const std::vector<Pulley>& pulleys) {
  constexpr double kBetter = 1.001;
  constexpr int kMostTimes = 5;
  int n_times = 0;
  for (std::size_t k = 0; k < radii.changes.size() && n_times < kMostTimes;) {
    auto other = exchange(fit, radii, k, pulleys);
    const bool is_better =
        other && !other->best.empty() && other->best.front().fall() > kBetter * radii.fall();
    if (is_better) radii = std::move(other->best.front());
    n_times += is_better ? 1 : 0;
    k = is_better ? 0 : k + 1;
  }
  return radii;
}

/// Pulleys that explain the logs as well in place of this one. Nothing: not known.
std::optional<std::vector<Pulley>> rivals_among(const RadiusFit& fit, const FittedRadii& radii,
                                                std::size_t k, const std::vector<Pulley>& pulleys) {
  const auto other = exchange(fit, radii, k, pulleys);
  if (!other) return {};
  std::vector<Pulley> rivals;
  for (const FittedRadii& one : other->best)
    if (is_as_good(one, radii, other->fall_before)) rivals.push_back(one.changes.back().pulley);
  return rivals;
}

/// The pulley whose radius explains most.
std::optional<WrongRadii> best_radius(const RigErrorSearch& search) {
  const RadiusFit fit(search.fitted, search.logs);
  const std::vector<Pulley> pulleys = pulleys_left(search, fit);
  const std::vector<FittedRadii> found = single_radii(fit, pulleys);
  if (found.empty() || !(found.front().fall() > 0)) return {};
  const FittedRadii& best = found.front();
  WrongRadii wrong = to_wrong_radii(best, pulleys.size(), fit.model());
  for (const FittedRadii& one : found)
    if (&one != &best && is_as_good(one, best, 0))
      wrong.all.front().rivals.push_back(one.changes.front().pulley);
  return wrong;
}

/// These radii and one more that is wrong together with them, or as many others that remove more.
/// Nothing where one of them is not significant.
std::optional<WrongRadii> and_one_more(const RigErrorSearch& search, const WrongRadii& wrong) {
  const RadiusFit fit(search.fitted, search.logs);
  const std::vector<Pulley> pulleys = pulleys_left(search, fit);
  const auto radii = fitted_radii(fit, changes_of(wrong));
  std::vector<FittedRadii> more;
  if (radii) more = with_one_more(fit, *radii, pulleys);
  if (wrong.all.size() == 1)
    for (FittedRadii& pair : radius_pairs(fit, pulleys)) more.push_back(std::move(pair));
  const auto most = std::max_element(
      more.begin(), more.end(),
      [](const FittedRadii& a, const FittedRadii& b) { return a.fall() < b.fall(); });
  if (most == more.end() || !(most->fall() > 0)) return {};
  const FittedRadii best = exchanged(fit, *most, pulleys);
  WrongRadii next = to_wrong_radii(best, pulleys.size(), fit.model());
  if (!next.are_significant(search.significance)) return {};
  for (std::size_t k = 0; k < next.all.size(); ++k)
    next.all[k].rivals = rivals_among(fit, best, k, pulleys).value_or(std::vector<Pulley>{});
  return next;
}

/// By the weights of fits with the right radii.
void set_shares(const std::vector<Model>& models, const RefineLogs& logs, WrongRadii& wrong) {
  const RadiusFit fit(models, logs);
  for (WrongRadius& one : wrong.all) {
    const auto right = fit.errors({{one.pulley, 0}}, true),
               given = fit.errors({{one.pulley, one.given - one.radius}}, true);
    if (right && given && given->held_out.sum() > 0)
      one.share = std::max(0.0, 1 - right->held_out.sum() / given->held_out.sum());
  }
}

std::function<void(Rig&)> change_of(const WrongRadii& wrong) {
  return [all = wrong.all](Rig& rig) {
    for (const WrongRadius& one : all) set_radius(rig.transmission, one.pulley, one.radius);
  };
}

std::vector<Model> with_radii(std::vector<Model> models, const WrongRadii& wrong) {
  for (const WrongRadius& one : wrong.all)
    models = with_radius(std::move(models), one.pulley, one.radius);
  return models;
}

/// Whether the radii moved by less than a part of their sd.
bool take_step(const CommonStep& step, WrongRadii& wrong) {
  bool is_near = true;
  for (std::size_t k = 0; k < wrong.all.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    WrongRadius& one = wrong.all[k];
    one.radius += step.change(at);
    one.scatter = std::sqrt(step.covariance(at, at));
    one.dof = step.n_blocks(at) - static_cast<double>(wrong.all.size());
    is_near = is_near && std::abs(step.change(at)) < kSettledSd * one.scatter;
  }
  return is_near;
}

/// The given models with the right radii. They are fitted again with the weights that the rows have
/// then; the first ones had the gap of the wrong radii in them.
std::vector<Model> with_right_radii(const RigErrorSearch& search, WrongRadii& wrong) {
  constexpr int kSteps = 6;
  const RadiusChanges none = unchanged(changes_of(wrong));
  std::vector<Model> models = with_radii({search.given.begin(), search.given.end()}, wrong);
  for (int i = 0; i < kSteps; ++i) {
    if (models.front().is_coupled())
      take_arm(with_rig(search.logs, change_of(wrong)), search.threads, models);
    const auto step = step_of(RadiusFit(models, search.logs), none);
    if (!step) break;
    const bool is_near = take_step(*step, wrong);
    models = with_radii(std::move(models), wrong);
    if (is_near) break;
  }
  return models;
}

Estimate radius_estimate(std::string_view name, double value, const Pulley& pulley,
                         const Model& model) {
  Estimate e;
  e.name = e.symbol = with_cable(name, pulley, model);
  e.unit = row_of(pulley).parameters.front().unit;
  e.value = value;
  return e;
}

std::vector<Rival> rivals_of(const WrongRadius& wrong, const Model& model) {
  std::vector<Rival> rivals;
  for (const Pulley& pulley : wrong.rivals) {
    const Effect& row = row_of(pulley);
    Rival& rival = rivals.emplace_back();
    rival.name = name_of(pulley, model);
    rival.side = to_string(row.site);
    rival.gain = wrong.share;
    rival.experiment = row.experiment;
    rival.joint = pulley.joint + 1;
  }
  return rivals;
}

std::string reason_of(const WrongRadius& wrong, const Model& model) {
  return fmt::format(
      "the {} radius of cable '{}' is {:.4g} mm by the motion of the joints (sd {:.1g} um), "
      "{:.4g} mm in the rig file",
      to_string(wrong.pulley.side), model.transmission.cables[wrong.pulley.cable].name,
      1e3 * wrong.radius, 1e6 * wrong.sd(), 1e3 * wrong.given);
}

/// Keeps the rivals that still explain the logs as well where other values of the rig are right.
void keep_rivals(const RigErrorSearch& search, WrongRadii& wrong) {
  if (std::all_of(wrong.all.begin(), wrong.all.end(),
                  [](const WrongRadius& one) { return one.rivals.empty(); }))
    return;
  std::vector<Model> models(search.given.begin(), search.given.end());
  for (const WrongRadius& one : wrong.all)
    models = with_radius(std::move(models), one.pulley, one.given);
  const RadiusFit fit(models, search.logs);
  const auto own = fitted_radii(fit, changes_of(wrong));
  if (!own) return;
  for (std::size_t k = 0; k < wrong.all.size(); ++k) {
    std::vector<Pulley>& rivals = wrong.all[k].rivals;
    if (rivals.empty()) continue;
    if (wrong.all.size() > 1) {
      rivals = rivals_among(fit, *own, k, rivals).value_or(rivals);
      continue;
    }
    std::erase_if(rivals, [&](const Pulley& pulley) {
      const std::vector<FittedRadii> other = single_radii(fit, {pulley});
      return !other.empty() && !is_as_good(other.front(), *own, 0);
    });
  }
}

WrongValue value_of(const WrongRadius& wrong, const WrongRadii& all, const Model& model) {
  const Effect& row = row_of(wrong.pulley);
  Estimate radius = radius_estimate(row.parameters.front().name, wrong.radius, wrong.pulley, model);
  radius.sd = wrong.sd();
  set_interval(radius, wrong.dof);
  WrongValue value;
  value.name = name_of(wrong.pulley, model);
  value.instance = {&row, {radius}};
  value.given = {radius_estimate("given", wrong.given, wrong.pulley, model)};
  value.joint = wrong.pulley.joint;
  value.chance = all.chance(wrong);
  value.share = wrong.share;
  value.rivals = rivals_of(wrong, model);
  value.reason = reason_of(wrong, model);
  return value;
}

/// `wrong`: begun with, and fitted again with what is given. Nothing where a radius then does not
/// differ any more.
std::optional<RigError> error_of(const RigErrorSearch& search, WrongRadii wrong) {
  RigError error;
  error.models = with_right_radii(search, wrong);
  if (!wrong.are_significant(search.significance)) return {};
  set_shares(error.models, search.logs, wrong);
  error.change = change_of(wrong);
  for (const WrongRadius& one : wrong.all)
    error.values.push_back(value_of(one, wrong, error.models.front()));
  error.again = [wrong](const RigErrorSearch& other) {
    WrongRadii anew = wrong;
    keep_rivals(other, anew);
    return error_of(other, std::move(anew));
  };
  error.with_one_more = [wrong](const RigErrorSearch& same) -> std::optional<RigError> {
    auto more = and_one_more(same, wrong);
    return more ? error_of(same, *std::move(more)) : std::nullopt;
  };
  return error;
}

}  // namespace

std::optional<RigError> wrong_radius(const RigErrorSearch& search) {
  const auto best = best_radius(search);
  if (!best) return {};
  if (best->are_significant(search.significance))
    if (auto error = error_of(search, *best)) return error;
  // Alone it may not stand out from what others leave that are wrong too.
  auto pair = search.n_most > 1 ? and_one_more(search, *best) : std::nullopt;
  return pair ? error_of(search, *std::move(pair)) : std::nullopt;
}

}  // namespace cablefit
