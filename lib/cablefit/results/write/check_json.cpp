#include "cablefit/results/write/check_json.hpp"

#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;
using result_json::text_or_null;

Json channel_json(const CheckedChannel& channel) {
  const ChannelSurvey& s = channel.survey;
  return Json{{"name", channel.name},
              {"unit", channel.unit},
              {"min", s.min},
              {"max", s.max},
              {"quantum", s.quantum},
              {"noise", s.noise},
              {"at_limits", s.at_limits}};
}

Json excitation_json(const CheckedExcitation& e) {
  if (e.channel.empty()) return nullptr;
  return Json{{"channel", e.channel},
              {"rest_speed", e.rest_speed},
              {"share_at_rest", e.share_at_rest},
              {"fastest", e.fastest},
              {"speed_bands", e.speed_bands}};
}

Json delay_json(const CheckedDelay& delay) {
  if (!delay.estimated) return nullptr;
  return Json{{"seconds", delay.seconds}, {"sd", delay.sd}, {"reason", delay.reason}};
}

Json part_json(const CheckedPart& part) {
  const PartSurvey& s = part.survey;
  return Json{{"preload", s.preload},
              {"run", s.run},
              {"phase", to_string(s.phase)},
              {"phase_given", s.phase_given},
              {"rows", s.n_rows},
              {"duration", s.t_last - s.t_first},
              {"rate", 1 / s.period},
              {"jitter", s.jitter},
              {"worst_jitter", s.worst_jitter},
              {"gaps", s.n_gaps},
              {"resampled", s.uneven},
              {"channels", list_of(part.channels, channel_json)},
              {"excitation", excitation_json(part.excitation)},
              {"torque_delay", delay_json(part.delay)},
              {"identifies", part.identifies},
              {"warnings", part.warnings}};
}

Json log_json(const CheckedLog& log) {
  return Json{{"path", log.path},
              {"rig", result_json::rig(log.rig_path)},
              {"linear_motion", result_json::linear_motion(log.axes)},
              {"usable", log.usable()},
              {"unused_columns", log.unused_columns},
              {"decisions", result_json::decisions(log.decisions)},
              {"parts", list_of(log.parts, part_json)}};
}

Json parameter_json(const PredictedParameter& p) {
  return Json{{"name", p.name},
              {"unit", p.unit},
              {"size", p.size},
              {"sd_best", p.sd_best},
              {"sd_first_look", p.sd_first_look},
              {"closest", text_or_null(p.closest)},
              {"correlation", p.correlation},
              {"verdict", to_string(p.determined)}};
}

Json equation_json(const PredictedEquation& e) {
  return Json{{"name", e.name},
              {"rows", e.rows},
              {"condition_scaled", e.condition_scaled},
              {"noise", e.noise},
              {"left", e.left},
              {"parameters", list_of(e.parameters, parameter_json)},
              {"sentences", e.sentences}};
}

Json prediction_json(const Prediction& p) {
  return Json{{"preload", p.preload},
              {"logs", p.logs},
              {"model", p.rigid ? "rigid" : "elastic"},
              {"linear_motion", result_json::linear_motion(p.axes)},
              {"cutoff", p.cutoff},
              {"equations", list_of(p.equations, equation_json)},
              {"none", text_or_null(p.none)}};
}

}  // namespace

std::string check_json(const CheckResult& result, const std::vector<Prediction>& predictions) {
  std::vector<InputFile> inputs;
  Json logs = Json::array();
  for (const CheckedLog& log : result.logs) {
    inputs.push_back({log.path, log.sha256, log.rows});
    logs.push_back(log_json(log));
  }
  Json json = result_json::header("check", inputs, result.warnings);
  json["logs"] = logs;
  json["identifiability"] = list_of(predictions, prediction_json);
  return result_json::text(json);
}

}  // namespace cablefit
