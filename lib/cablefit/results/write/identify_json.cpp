#include "cablefit/results/write/identify_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json equations_json(const std::vector<IdentifyEquation>& equations) {
  Json json = Json::object();
  for (const IdentifyEquation& e : equations)
    json[e.name] = {{"rms", e.rms},
                    {"weight", e.weight},
                    {"effective_rows", e.effective_rows},
                    {"counts", result_json::row_counts(e.counts)}};
  return json;
}

Json line_json(const LineStiffness& line) {
  return Json{{"range", {line.low, line.high}},
              {"measured", line.measured},
              {"sd", line.sd},
              {"model", line.model}};
}

/// Of one joint its line, of several a list with names.
Json lines_json(const IdentifyPreload& preload) {
  if (preload.transmission.n_joints == 1)
    return preload.lines.empty() ? Json() : line_json(preload.lines.front());
  Json list = Json::array();
  for (const LineStiffness& line : preload.lines) {
    list.push_back(line_json(line));
    list.back()["name"] = line.name;
  }
  return list;
}

Json elongation_json(const IdentifyPreload& preload, const Cable& cable) {
  const Estimate* e = find_estimate(preload.parameters, elongation_name(cable));
  return e == nullptr || e->not_identifiable.empty() ? Json(cable.initial_elongation) : Json();
}

Json cables_json(const IdentifyPreload& preload) {
  Json list = Json::array();
  for (const Cable& cable : preload.transmission.cables)
    list.push_back({{"name", cable.name},
                    {"law", cable.law->name},
                    {"order", cable.order},
                    {"initial_elongation", elongation_json(preload, cable)}});
  return list;
}

Json slack_json(const IdentifyPreload& preload) {
  Json list = Json::array();
  for (const SlackPoint& point : preload.slack)
    list.push_back({{"cable", preload.transmission.cables[point.cable].name},
                    {"deflection", point.deflection},
                    {"link_torque", point.link},
                    {"motor_torque", point.motor},
                    {"slack", point.slack_above ? "above" : "below"}});
  return list;
}

/// As its file has it, so that the result is a model too; null where no motion was identified.
Json model_or_null(const IdentifyPreload& preload) {
  return preload.model ? Json::parse(model_json(*preload.model)) : Json();
}

Json preload_json(const IdentifyPreload& preload) {
  return Json{{"name", preload.name},
              {"rig", result_json::rig(preload.rig_path)},
              {"parameters", result_json::parameters(preload.parameters)},
              {"derived", result_json::parameters(preload.derived)},
              {"cables", cables_json(preload)},
              {"deflection_range", {preload.deflection_low, preload.deflection_high}},
              {"equilibrium_torque", preload.equilibrium},
              {"linear_K", lines_json(preload)},
              {"slack_points", slack_json(preload)},
              {"equations", equations_json(preload.equations)},
              {"resonance_hz", preload.resonance > 0 ? Json(preload.resonance) : Json()},
              {"load_inertia", preload.load_inertia},
              {"model", model_or_null(preload)},
              {"decisions", result_json::decisions(preload.decisions)},
              {"warnings", preload.warnings}};
}

Json profile_json(const ElongationProfile& profile) {
  return Json{{"preload", profile.preload},   {"name", profile.name},
              {"unit", profile.unit},         {"l_o", profile.l_o},
              {"deviance", profile.deviance}, {"threshold", profile.threshold},
              {"low", number(profile.low)},   {"high", number(profile.high)}};
}

}  // namespace

std::string identify_json(const IdentifyResult& result) {
  Json json = result_json::header("identify", result.inputs, result.warnings);
  json["parameters"] = result_json::parameters(result.parameters);
  json["preloads"] = list_of(result.preloads, preload_json);
  json["profiles"] = list_of(result.profiles, profile_json);
  json["active_bounds"] = result.active_bounds;
  json["condition"] = number(result.condition);
  json["decisions"] = result_json::decisions(result.decisions);
  return result_json::text(json);
}

}  // namespace cablefit
