#include "cablefit/refine/steps/elastic_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/steps/determined_effects.hpp"

namespace cablefit {
namespace {

constexpr double kVisibleSd = 3;
constexpr std::string_view kUnnamed = "default";  // preload of logs that name none

bool is_blocked(const PartSurvey& part) { return part.phase == Phase::blocked; }

template <typename Predicate>
bool any_part_of(const RefineLogs& logs, Predicate predicate) {
  for (const auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (const LogSurvey& log : *some)
      if (std::any_of(log.parts.begin(), log.parts.end(), predicate)) return true;
  return false;
}

/// Those of the base that are not there yet, at 0.
void add_motor_effects(Model& model) {
  std::vector<EffectInstance>& motor = model.joints.front().motor;
  for (EffectInstance& blank : base_instances(Side::motor, 1, model.rig,
                                              [](const Estimate& e) { return std::optional(e); })) {
    const bool there = std::any_of(motor.begin(), motor.end(), [&](const EffectInstance& instance) {
      return instance.effect == blank.effect;
    });
    if (there) continue;
    blank.parameters.front().value = 0;
    motor.push_back(std::move(blank));
  }
}

/// Without the effect that a blocked log shows least: the first that has no own column, else the
/// one with the least |value| / sd below kVisibleSd, where a negative value of what must be
/// positive counts as 0. Nothing: all are visible.
const Effect* least_visible(const Design& design, double block_seconds) {
  const std::vector<EffectInstance>& motor = design.models.front().joints.front().motor;
  const auto fit = fit_blocks(block_grams(design, block_seconds), {1, 1, 1}, false);
  if (!fit) return motor.size() > 1 ? motor.front().effect : nullptr;
  const Effect* least = nullptr;
  double fewest = kVisibleSd;
  for (std::size_t k = 0; k < motor.size(); ++k) {
    const ParameterInfo& info = motor[k].effect->parameters.front();
    const Eigen::Index at = design.layout.n_link + static_cast<Eigen::Index>(k);
    const double sd = std::sqrt(fit->covariance(at, at));
    const double visible = fit->x(at) < info.lower ? 0 : std::abs(fit->x(at)) / sd;
    const bool may_go = std::isfinite(info.lower);  // an offset costs nothing
    if (!may_go || visible >= fewest) continue;
    fewest = visible;
    least = motor[k].effect;
  }
  return least;
}

/// Range of theta over its rms speed, s: how long it takes to go through what there is.
double travel_time(std::span<const Stretch> stretches) {
  constexpr double kStep = 0.1;  // s, long enough for rounding not to look like speed
  double low = kUnbounded, high = -kUnbounded, squares = 0, n = 0;
  for (const Stretch& stretch : stretches) {
    const Eigen::ArrayXd& theta = stretch.recording.theta;
    const auto lag = std::max<Eigen::Index>(1, std::llround(kStep / stretch.recording.period));
    low = std::min(low, theta.minCoeff());
    high = std::max(high, theta.maxCoeff());
    if (theta.size() <= lag) continue;
    const Eigen::ArrayXd speed = (theta.tail(theta.size() - lag) - theta.head(theta.size() - lag)) /
                                 (static_cast<double>(lag) * stretch.recording.period);
    squares += speed.square().sum();
    n += static_cast<double>(speed.size());
  }
  return squares > 0 ? (high - low) / std::sqrt(squares / n) : 0;
}

Smoothing widened(const Smoothing& narrowest, double signals, double period) {
  Smoothing s = narrowest;
  const double factor = signals / narrowest.signals;
  s.signals *= factor;
  s.columns *= factor;
  s.every = std::max<Eigen::Index>(1, std::llround(factor)) * narrowest.every;
  s.stride = stride_for(s.columns, period, s.every);
  return s;
}

constexpr double kEnough = 0.25;  // of the rows that there could be without rest

/// How near the stretches come to having enough rows, 0 .. 1.
double enough_rows(const Design& design) {
  double sum = 0;
  for (std::size_t k = 0; k < design.stretches.size(); ++k) {
    double n = 0;
    for (const KindRows& kind : design.rows[k].kinds) n += static_cast<double>(kind.at.size());
    const Eigen::Index samples = design.stretches[k].recording.theta.size();
    const Eigen::Index all = std::max<Eigen::Index>(1, samples / design.smoothing_of(k).stride);
    sum += std::min(1.0, n / (kEnough * static_cast<double>(all)));
  }
  return sum / static_cast<double>(design.stretches.size());
}

/// A single model that says which preload it is of has nothing to say of another.
PartFilter of_preload(std::span<const Model> models) {
  const std::string own = models.front().preload;
  if (models.size() > 1 || own.empty() || own == kUnnamed)
    return [](const PartSurvey&) { return true; };
  return [own](const PartSurvey& part) { return part.preload == own; };
}

void require_preload(std::span<const Model> models, const RefineLogs& logs) {
  const PartFilter own = of_preload(models);
  for (const auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (const LogSurvey& log : *some)
      if (!log.parts.empty() && std::none_of(log.parts.begin(), log.parts.end(), own))
        throw input_error({log.plan.path},
                          fmt::format("the log is of preload '{}', the model of '{}'",
                                      log.parts.front().preload, models.front().preload),
                          "give a model of every preload, or leave the log out");
}

/// Of the effects that the models have, those that a blocked link shows could be fitted anew.
void require_static(std::span<const Model> models) {
  for (const Model& model : models)
    for (const EffectInstance& has : model.joints.front().added)
      if (!has.effect->is_static)
        throw input_error(
            {},
            fmt::format("the model has '{}' ({}), which no log with the link blocked shows",
                        has.effect->name, to_string(has.effect->site)),
            "give moving logs too, or a model without it");
}

}  // namespace

RefineStage stage_of(std::span<const Model> models, const RefineLogs& logs) {
  RefineStage stage;
  stage.models.assign(models.begin(), models.end());
  stage.wanted = of_preload(models);
  require_preload(models, logs);
  if (models.front().rigid) return stage;
  const bool from_stage_1 = models.front().joints.front().link.empty();
  const bool any_moves = any_part_of(logs, [](const PartSurvey& p) { return !is_blocked(p); });
  stage.elastic_only = from_stage_1 || !any_moves;
  if (!stage.elastic_only) return stage;
  if (!any_part_of(logs, is_blocked))
    throw input_error({}, "no log with the link blocked",
                      "a result of 'cablefit elastic' is refined from blocked logs; for moving "
                      "logs give a result of 'cablefit dynamic' or 'identify'");
  if (any_moves)
    stage.warnings.emplace_back(
        "moving parts of the logs were not used: the model is of stage 1 and has no "
        "inertia");
  require_static(models);
  stage.wanted = [own = of_preload(models)](const PartSurvey& part) {
    return is_blocked(part) && own(part);
  };
  for (Model& model : stage.models) {
    model.joints.front().link.clear();
    model.arm.clear();
    add_motor_effects(model);
  }
  return stage;
}

Smoothing blocked_smoothing(std::span<const Model> models, const std::vector<Stretch>& stretches) {
  constexpr double kOfTravel = 0.004;  // of the time for the whole range
  constexpr double kWidest = 0.1;      // s
  constexpr double kWider = 1.6, kAlmost = 0.95;
  const double period = finest_period(stretches, true);
  const Smoothing narrowest = smoothing_for(period);
  const double widest = std::max(kWidest, narrowest.signals);
  double width = std::clamp(kOfTravel * travel_time(stretches), narrowest.signals, widest);
  Smoothing best;
  double most = -1;
  while (width <= kWider * widest) {
    // A row requires the same sign of the speed all over its kernel, which does not occur at rest.
    constexpr double kOfUsual = 0.5;
    Smoothing tried = make_design(models, stretches, widened(narrowest, width, period)).smoothing;
    tried.least_speed_theta *= kOfUsual;
    tried.least_speed_blocked *= kOfUsual;
    const double enough = enough_rows(make_design(models, stretches, tried));
    if (enough > most) best = tried;
    most = std::max(most, enough);
    if (most > kAlmost) break;
    width *= kWider;
  }
  return best;
}

std::vector<Model> with_visible_effects(std::vector<Model> models,
                                        const std::vector<Stretch>& stretches,
                                        const Smoothing& smoothing, double block_seconds) {
  while (const Effect* least =
             least_visible(design_of(models, stretches, smoothing), block_seconds))
    remove_effect(*least, false, models);
  return models;
}

}  // namespace cablefit
