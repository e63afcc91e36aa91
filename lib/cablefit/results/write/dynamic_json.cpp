#include "cablefit/results/write/dynamic_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/model/file/writer.hpp"
#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"
#include "cablefit/results/write/proof_json.hpp"
#include "cablefit/results/write/validation_json.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;

Json errors_json(const std::map<std::string, TorqueError>& errors) {
  Json json = Json::object();
  for (const auto& [equation, error] : errors) {
    json[equation] = {{"rms", error.rms}, {"max_abs", error.max_abs}, {"relative", error.relative}};
  }
  return json;
}

template <typename Value>
Json by_name(const std::map<std::string, Value>& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

Json stage1_json(const ElasticFit& fit) {
  Json json{{"order", fit.order},
            {"theta_0", result_json::per_joint(fit.transmission.encoder_zero())},
            {"offset", result_json::offset(fit)},
            {"parameters", result_json::parameters(fit.parameters)}};
  if (const Json curve = result_json::curve_coefficients(fit); !curve.is_null())
    json["curve_coefficients"] = curve;
  return json;
}

Json suspects_json(const std::vector<SuspectSpan>& spans) {
  Json json = Json::array();
  for (const SuspectSpan& span : spans)
    json.push_back(Json{{"equation", span.equation},
                        {"log", span.log},
                        {"run", span.run},
                        {"from", span.from},
                        {"to", span.to},
                        {"largest", span.largest},
                        {"rows", span.n_rows}});
  return json;
}

Json sweep_json(const Sweep& sweep) {
  Json points = Json::array(), verdicts = Json::array();
  for (const SweepPoint& point : sweep.points)
    points.push_back(Json{{"setting", point.setting},
                          {"factor", point.factor},
                          {"value", point.value},
                          {"change_in_sd", point.change}});
  for (const SweepVerdict& verdict : sweep.verdicts)
    verdicts.push_back(
        Json{{"setting", verdict.setting}, {"flat", verdict.is_flat}, {"verdict", verdict.text}});
  return Json{{"parameters", sweep.parameters}, {"points", points}, {"verdicts", verdicts}};
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json online_json(const DynamicFit& fit, const RecursiveTrace& trace) {
  const OnlineRule& rule = trace.rule;
  Json parameters = Json::array();
  for (std::size_t k = 0; k < trace.names.size(); ++k) {
    const OnlineEnd end = online_end(trace, k, fit.parameters[k]);
    parameters.push_back(Json{{"name", trace.names[k]},
                              {"unit", trace.units[k]},
                              {"value", number_or_null(end.value)},
                              {"sd", number_or_null(end.sd)},
                              {"difference_in_sd", number_or_null(end.difference)}});
  }
  return Json{{"method", rule.method},
              {"memory", rule.memory > 0 ? Json(rule.memory) : Json()},
              {"forgetting", rule.step > 0 ? Json() : Json(rule.forgetting)},
              {"step", rule.step > 0 ? Json(rule.step) : Json()},
              {"slowest", rule.step > 0 ? number_or_null(rule.slowest) : Json()},
              {"parameters", parameters}};
}

Json covariance_or_null(const ParameterCovariance& covariance) {
  return covariance.empty() ? Json() : model_file::covariance_json(covariance);
}

Json fit_json(const DynamicFit& fit) {
  Json json{{"model", fit.model},
            {"estimator", fit.estimator},
            {"parameters", result_json::parameters(fit.parameters)},
            {"covariance", covariance_or_null(fit.covariance)},
            {"derived", result_json::parameters(fit.derived)},
            {"torque_error", errors_json(fit.torque_error)},
            {"weight", by_name(fit.weight)},
            {"condition", by_name(fit.condition)},
            {"effective_rows", by_name(fit.effective_rows)}};
  for (std::size_t joint = 0; joint < fit.effects.size(); ++joint)
    for (const EffectInstance& effect : fit.effects[joint]) {
      json["effects"].push_back(model_file::refinement_json(effect));
      if (fit.effects.size() > 1) json["effects"].back()["joint"] = joint + 1;
    }
  if (fit.elastic) json["elastic"] = stage1_json(*fit.elastic);
  json["sd_reason"] = by_name(fit.sd_reason);
  json["systematic"] = {{"method_floor", by_name(fit.method_floor)},
                        {"estimator_difference", by_name(fit.estimator_difference)},
                        {"stage1_misfit", by_name(fit.stage1_misfit)}};
  if (!fit.suspects.empty()) json["suspects"] = suspects_json(fit.suspects);
  for (const RecursiveTrace& trace : fit.traces) json["online"].push_back(online_json(fit, trace));
  if (fit.sweep) json["sweep"] = sweep_json(*fit.sweep);
  json["verdicts"] = by_name(fit.verdicts);
  json["warnings"] = fit.warnings;
  if (fit.proof) json["prove"] = result_json::proof(*fit.proof);
  return json;
}

Json delay_json(const TorqueDelay& delay) {
  Json json{{"seconds", nullptr}, {"sd", nullptr}, {"held", delay.held}, {"reason", delay.reason}};
  if (delay.period > 0) json["period"] = delay.period;
  if (!delay.estimated) return json;
  json["seconds"] = delay.seconds;
  json["sd"] = delay.sd;
  return json;
}

Json counts_json(const DynamicPreload& preload) {
  Json counts = result_json::window_counts(preload.windows);
  counts["equations"] = Json::object();
  for (const auto& [equation, rows] : preload.counts) {
    counts["equations"][equation] = result_json::row_counts(rows);
  }
  return counts;
}

Json preload_json(const DynamicPreload& preload) {
  Json json{{"name", preload.name},
            {"rig", result_json::rig(preload.rig_path)},
            {"linear_motion", result_json::linear_motion(preload.axes)},
            {"resonance_hz", preload.resonance > 0 ? Json(preload.resonance) : Json()},
            {"load_inertia", preload.load_inertia},
            {"torque_delay", delay_json(preload.delay)},
            {"fits", list_of(preload.fits, fit_json)},
            {"counts", counts_json(preload)},
            {"decisions", result_json::decisions(preload.decisions)},
            {"residual_tests", result_json::residual_tests(preload.residual_tests)},
            {"warnings", preload.warnings}};
  if (preload.validation) json["validation"] = result_json::validation(*preload.validation);
  return json;
}

}  // namespace

std::string dynamic_json(const DynamicResult& result) {
  Json json = result_json::header("dynamic", result.inputs, result.warnings);
  json["preloads"] = list_of(result.preloads, preload_json);
  return result_json::text(json);
}

}  // namespace cablefit
