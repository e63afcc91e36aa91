#include "cablefit/campaign/preload_advice.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/campaign/cells/cell_fit.hpp"
#include "cablefit/design/collision.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

void take_friction(const DynamicFit& fit, PreloadAdvice& advice) {
  const Estimate* sum = find_estimate(fit.derived, "f_dry");
  if (sum != nullptr) {
    advice.friction = sum->value;
    advice.friction_sd = sum->sd;
    return;
  }
  const Estimate* link = find_estimate(fit.parameters, "f_s");
  const Estimate* motor = find_estimate(fit.parameters, "f_sm");
  advice.friction = (link != nullptr ? link->value : 0) + (motor != nullptr ? motor->value : 0);
  advice.friction_sd = std::numeric_limits<double>::quiet_NaN();
}

/// The range around zero on which no cable is slack.
void take_closure(const ElasticFit& fit, PreloadAdvice& advice) {
  if (!is_preloaded(fit.transmission)) return;
  advice.closure_low = advice.deflection_low;
  advice.closure_high = advice.deflection_high;
  for (const SlackPoint& point :
       slack_points(fit.transmission, advice.deflection_low, advice.deflection_high)) {
    if (point.slack_above)
      advice.closure_high = std::min(advice.closure_high, point.deflection);
    else
      advice.closure_low = std::max(advice.closure_low, point.deflection);
  }
}

/// sd of the mean of the link's residual over a window; where no residual was looked at its rms,
/// as if it did not average at all.
double mean_noise(const DynamicPreload& stage2, const DynamicFit& fit, double window) {
  const std::string_view link = to_string(Side::link);
  for (const JudgedEquation& e : stage2.residual_tests)
    if (e.model == fit.model && e.equation == link && !e.means.empty())
      return sd_of_mean(e.means, window);
  return fit.torque_error.at(std::string(link)).rms;
}

double smallest_collision(double noise, double model_error, const AdviceDetector& detector) {
  CollisionDetector d;
  d.mean_noise = noise;
  d.window = detector.window;
  d.model_error = model_error;
  d.false_alarm_rate = false_alarm_rate_of(detector.false_alarms_per_hour, detector.window);
  d.detection_rate = detector.detection_rate;
  return collision_threshold(d).torque;
}

std::optional<PreloadAdvice> advice_of(const BatchCell& cell, const AdviceDetector& detector) {
  if (!cell.elastic || !cell.dynamic) return {};
  const ElasticPreload& stage1 = cell.elastic->preloads.front();
  const DynamicPreload& stage2 = cell.dynamic->preloads.front();
  const ElasticFit* line = stage1.find("linear");
  const ElasticFit* chosen = stage1.find(stage1.selected);
  const DynamicFit* fit = chosen_fit(*cell.elastic, stage2);
  if (line == nullptr || chosen == nullptr || fit == nullptr || line->transmission.n_joints > 1)
    return {};
  if (!fit->torque_error.contains(std::string(to_string(Side::link)))) return {};
  PreloadAdvice advice;
  advice.cell = cell.name;
  advice.deflection_low = stage1.deflection_low;
  advice.deflection_high = stage1.deflection_high;
  advice.linear_error = line->max_abs_error;
  advice.linear_share = line->max_abs_error / stage1.peak_torque;
  advice.model = chosen->model;
  advice.model_error = chosen->max_abs_error;
  take_friction(*fit, advice);
  take_closure(*chosen, advice);
  const double noise = mean_noise(stage2, *fit, detector.window);
  advice.collision_linear = smallest_collision(noise, advice.linear_error, detector);
  advice.collision_model = smallest_collision(noise, advice.model_error, detector);
  return advice;
}

}  // namespace

std::vector<PreloadAdvice> preload_advice(const std::vector<BatchCell>& cells,
                                          const AdviceDetector& detector) {
  std::vector<PreloadAdvice> all;
  for (const BatchCell& cell : cells)
    if (auto advice = advice_of(cell, detector)) all.push_back(std::move(*advice));
  return all;
}

}  // namespace cablefit
