#include "cablefit/refine/wrong_radius.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/refine/radius_fit.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/search/golden.hpp"

namespace cablefit {
namespace {

constexpr double kFirstStep = 0.005;  // of the cable's largest radius
// Of the cable's largest radius: errors of smoothed motion, which no scatter over blocks shows.
// 43 simulated fingers and arms had up to 4e-5.
constexpr double kLeastSd = 2e-5;
constexpr int kMostDoublings = 9;     // to over twice the largest radius
constexpr std::size_t kLookedAt = 4;  // pulleys that are fitted, of those that promise most

double largest_radius(const Cable& cable) {
  double largest = 0;
  for (const auto* maps : {&cable.motor_map, &cable.link_map})
    for (const DisplacementMap& map : *maps) largest = std::max(largest, std::abs(map.radius(0)));
  return largest;
}

/// How much the squared residual falls, as far as a few radii show.
struct Promise {
  Pulley pulley;
  double from = 0, step = 0;  ///< m, changes of the radius: the minimum is from `from` on, in steps
  double fall = 0;
  double given = 0;  ///< squared residual with the given radius
};

/// Near the given radius, by a parabola. It must be narrow: a cable that is too long and one that
/// is too short do not leave the same residual. `given`: squared residual with the given radius.
std::optional<Promise> near_promise(const RadiusFit& fit, const Pulley& pulley, double given,
                                    double h) {
  constexpr int kTimes = 4;
  constexpr double kNarrower = 0.2;
  for (int i = 0; i < kTimes; ++i, h *= kNarrower) {
    const auto less = fit.errors(pulley, -h, false), more = fit.errors(pulley, h, false);
    if (!less || !more) return {};
    const double slope = (more->sum() - less->sum()) / 2;
    const double least = std::min(less->sum(), more->sum());
    if (least > given && i + 1 < kTimes) continue;
    const double bend = more->sum() - 2 * given + less->sum();
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
    const auto errors = fit.errors(pulley, change, false);
    if (!errors || !(given - errors->sum() > best.fall)) continue;
    best.fall = given - errors->sum();
    best.from = (std::abs(i) - 1) * kStep * (i < 0 ? -largest : largest);
    best.step = change - best.from;
  }
  if (best.step == 0) return {};
  return best;
}

std::optional<Promise> promise_of(const RadiusFit& fit, const Pulley& pulley) {
  const double largest = largest_radius(fit.model().transmission.cables[pulley.cable]);
  const auto errors = fit.errors(pulley, 0, false);
  if (!errors) return {};
  const double given = errors->sum();
  const auto near = near_promise(fit, pulley, given, kFirstStep * largest);
  if (radius_of(fit.model().transmission, pulley) != 0) return near;
  const auto far = far_promise(fit, pulley, given, largest);
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

/// The minimum of a parabola through three radii, `h` (m) apart.
struct Minimum {
  double step = 0;  ///< m, from the middle one
  /// m, the sandwich over blocks of time: slopes of their own errors over the curvature of the sum.
  double sd = 0;
  double dof = 1;
};

std::optional<Minimum> minimum_near(const RadiusFit& fit, const Pulley& pulley, double change,
                                    double h) {
  const auto less = fit.errors(pulley, change - h, false), same = fit.errors(pulley, change, false),
             more = fit.errors(pulley, change + h, false);
  if (!less || !same || !more) return {};
  const Eigen::ArrayXd slopes = (more->in_sample - less->in_sample) / (2 * h);
  const double bend = (more->sum() - 2 * same->sum() + less->sum()) / (h * h);
  if (!(bend > 0)) return {};
  const double scatter = std::sqrt((slopes - slopes.mean()).square().sum());
  return Minimum{-slopes.sum() / bend, scatter / bend,
                 std::max(1.0, static_cast<double>(slopes.size()) - 1)};
}

/// A radius with the least squared residual.
struct Fitted {
  Pulley pulley;
  double change = 0;  ///< m
  Minimum near;
  RadiusFit::Errors errors;
  double given = 0;  ///< squared residual with the given radius

  double fall() const { return given - errors.sum(); }
};

double first_step(const Transmission& transmission, const Pulley& pulley) {
  return kFirstStep * largest_radius(transmission.cables[pulley.cable]);
}

std::optional<Fitted> fitted(const RadiusFit& fit, const Promise& promise) {
  const auto sum_at = [&](double change) {
    const auto errors = fit.errors(promise.pulley, change, false);
    return errors ? errors->sum() : kUnbounded;
  };
  double before = promise.from, at = promise.from + promise.step, least = sum_at(at);
  double beyond = at + promise.step;
  for (int i = 0; i < kMostDoublings; ++i) {
    const double next = sum_at(beyond);
    if (!(next < least)) break;
    least = next;
    before = at;
    at = beyond;
    beyond = at + 2 * (at - before);
  }
  double low = before, high = beyond;
  for (int i = 0; i < 2; ++i) {  // the golden section is exact to 1 % of its range
    const double found = golden(low, high, sum_at);
    const double width = 0.05 * std::abs(high - low);
    low = found - width;
    high = found + width;
  }
  const double change = (low + high) / 2;
  const auto errors = fit.errors(promise.pulley, change, true);
  const auto minimum = minimum_near(fit, promise.pulley, change,
                                    first_step(fit.model().transmission, promise.pulley));
  if (!errors || !minimum) return {};
  return Fitted{promise.pulley, change, *minimum, *errors, promise.given};
}

/// Whether both leave the same, to within the scatter over blocks of time.
bool is_as_good(const Fitted& one, const Fitted& best) {
  constexpr double kSameSd = 2, kSameShare = 0.02;
  if (one.errors.held_out.size() != best.errors.held_out.size())  // other joints show it
    return false;
  const Paired difference = paired(one.errors.held_out, best.errors.held_out);
  return difference.in_sd() < kSameSd || difference.sum < kSameShare * best.given;
}

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
  double given = 0, radius = 0, sd = 0;  ///< m, signed
  double dof = 1;                        ///< of the t distribution of the radius
  std::size_t n_tried = 1;
  double share = 0;            ///< on held-out blocks
  std::vector<Pulley> rivals;  ///< whose radius explains the logs as well

  /// That the radius differs so much where it is right, of as many as were tried.
  double chance() const {
    return std::min(1.0, static_cast<double>(n_tried) * t_tail(std::abs(radius - given) / sd, dof));
  }
};

/// The pulley whose radius explains most. Nothing where none is significant.
std::optional<WrongRadius> best_radius(const RigErrorSearch& search) {
  const std::vector<Model>& models = search.fitted;
  std::vector<Pulley> pulleys = pulleys_of(models.front());
  std::erase_if(pulleys, [&](const Pulley& pulley) {
    return search.has(name_of(pulley, models.front()), site_of(pulley.side), pulley.joint);
  });
  if (pulleys.empty()) return {};
  const RadiusFit fit(models, search.logs);
  const std::vector<Promise> promises = most_promising(fit, pulleys);
  std::vector<Fitted> found;
  for (std::size_t k = 0; k < std::min(kLookedAt, promises.size()); ++k)
    if (auto one = fitted(fit, promises[k])) found.push_back(*std::move(one));
  const Fitted* best = nullptr;
  for (const Fitted& one : found)
    if (one.fall() > (best != nullptr ? best->fall() : 0)) best = &one;
  if (best == nullptr || !(best->near.sd > 0)) return {};
  WrongRadius wrong;
  wrong.pulley = best->pulley;
  wrong.given = radius_of(models.front().transmission, wrong.pulley);
  wrong.radius = wrong.given + best->change;
  wrong.sd = best->near.sd;
  wrong.dof = best->near.dof;
  wrong.n_tried = promises.size();
  wrong.share = best->fall() / best->given;
  for (const Fitted& one : found)
    if (&one != best && is_as_good(one, *best)) wrong.rivals.push_back(one.pulley);
  if (!(wrong.chance() < search.significance)) return {};
  return wrong;
}

/// By the weights of fits with the right radius.
void set_share(const std::vector<Model>& models, const RefineLogs& logs, WrongRadius& wrong) {
  const RadiusFit fit(models, logs);
  const auto right = fit.errors(wrong.pulley, 0, true),
             given = fit.errors(wrong.pulley, wrong.given - wrong.radius, true);
  if (right && given && given->held_out.sum() > 0)
    wrong.share = std::max(0.0, 1 - right->held_out.sum() / given->held_out.sum());
}

std::function<void(Rig&)> change_of(const WrongRadius& wrong) {
  return [pulley = wrong.pulley, radius = wrong.radius](Rig& rig) {
    set_radius(rig.transmission, pulley, radius);
  };
}

/// The given models with the right radius. It is fitted again with the weights that the rows have
/// then; the first ones had the gap of the wrong radius in them.
std::vector<Model> with_right_radius(const RigErrorSearch& search, WrongRadius& wrong) {
  constexpr int kSteps = 4;
  constexpr double kFarSd = 10, kNearSd = 0.1;
  std::vector<Model> models =
      with_radius({search.given.begin(), search.given.end()}, wrong.pulley, wrong.radius);
  double h = first_step(models.front().transmission, wrong.pulley);
  for (int i = 0; i < kSteps; ++i) {
    if (models.front().is_coupled())
      take_arm(
          with_rig(search.logs,
                   [&](Rig& rig) { set_radius(rig.transmission, wrong.pulley, wrong.radius); }),
          search.threads, models);
    const RadiusFit fit(models, search.logs);
    const auto minimum = minimum_near(fit, wrong.pulley, 0, h);
    if (!minimum || !(minimum->sd > 0)) break;
    wrong.radius += minimum->step;
    wrong.sd = minimum->sd;
    wrong.dof = minimum->dof;
    models = with_radius(std::move(models), wrong.pulley, wrong.radius);
    if (std::abs(minimum->step) < kNearSd * minimum->sd) break;
    h = std::min(h, kFarSd * minimum->sd);
  }
  set_share(models, search.logs, wrong);
  wrong.sd = std::hypot(
      wrong.sd, kLeastSd * largest_radius(models.front().transmission.cables[wrong.pulley.cable]));
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
      1e3 * wrong.radius, 1e6 * wrong.sd, 1e3 * wrong.given);
}

/// Those that still explain the logs as well where other values of the rig are right.
std::vector<Pulley> rivals_left(const RigErrorSearch& search, const WrongRadius& wrong) {
  if (wrong.rivals.empty()) return {};
  const RadiusFit fit(
      with_radius({search.given.begin(), search.given.end()}, wrong.pulley, wrong.given),
      search.logs);
  const auto of = [&](const Pulley& pulley) {
    const auto promise = promise_of(fit, pulley);
    return promise ? fitted(fit, *promise) : std::nullopt;
  };
  const auto own = of(wrong.pulley);
  std::vector<Pulley> left;
  for (const Pulley& pulley : wrong.rivals) {
    const auto other = of(pulley);
    if (!own || !other || is_as_good(*other, *own)) left.push_back(pulley);
  }
  return left;
}

/// `wrong`: begun with, and fitted again with what is given.
RigError error_of(const RigErrorSearch& search, WrongRadius wrong) {
  RigError error;
  error.name = name_of(wrong.pulley, search.given.front());
  error.models = with_right_radius(search, wrong);
  error.change = change_of(wrong);
  const Model& model = error.models.front();
  const Effect& row = row_of(wrong.pulley);
  Estimate radius = radius_estimate(row.parameters.front().name, wrong.radius, wrong.pulley, model);
  radius.sd = wrong.sd;
  set_interval(radius, wrong.dof);
  error.instance = {&row, {radius}};
  error.given = {radius_estimate("given", wrong.given, wrong.pulley, model)};
  error.joint = wrong.pulley.joint;
  error.chance = wrong.chance();
  error.share = wrong.share;
  error.rivals = rivals_of(wrong, model);
  error.reason = reason_of(wrong, model);
  error.again = [wrong](const RigErrorSearch& other) {
    WrongRadius anew = wrong;
    anew.rivals = rivals_left(other, wrong);
    return error_of(other, std::move(anew));
  };
  return error;
}

}  // namespace

std::optional<RigError> wrong_radius(const RigErrorSearch& search) {
  auto wrong = best_radius(search);
  if (!wrong) return {};
  return error_of(search, *std::move(wrong));
}

}  // namespace cablefit
