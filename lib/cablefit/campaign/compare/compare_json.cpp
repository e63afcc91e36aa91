#include "cablefit/campaign/compare/compare_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;

Json recorded_json(const RecordedResult& result) {
  return Json{{"path", result.path},
              {"command", result.command},
              {"cablefit_version", result.version},
              {"logs", std::count_if(result.inputs.begin(), result.inputs.end(),
                                     [](const InputFile& input) { return input.rows > 0; })}};
}

Json parameter_json(const ComparedParameter& p) {
  return Json{{"stage", p.stage},
              {"preload", p.preload},
              {"model", p.model},
              {"name", p.name},
              {"unit", p.unit},
              {"first", {{"value", p.first}, {"sd", p.first_sd}}},
              {"second", {{"value", p.second}, {"sd", p.second_sd}}},
              {"difference", p.difference},
              {"difference_percent", p.percent()},
              {"sd", p.sd},
              {"degrees_of_freedom", p.sd > 0 ? Json(p.dof) : Json()},
              {"ci_together", {p.low, p.high}},
              {"p_value", p.p_value},
              {"p_together", p.p_together},
              {"margin", p.margin},
              {"within_margin", p.is_within_margin},
              {"verdict", to_string(p.sameness)},
              {"more_data", p.sameness == Sameness::undecided ? Json(p.more_data) : Json()}};
}

}  // namespace

std::string compare_json(const CompareResult& result, const std::vector<InputFile>& inputs,
                         const std::vector<std::string>& failed_gates) {
  Json json = result_json::header("compare", inputs, result.warnings);
  json["first"] = recorded_json(result.first);
  json["second"] = recorded_json(result.second);
  json["margin_percent"] = 100 * result.options.margin;
  json["significance"] = result.options.significance;
  json["verdict"] = to_string(result.sameness());
  json["parameters"] = list_of(result.parameters, parameter_json);
  json["not_compared"] = Json::array();
  for (const Uncompared& one : result.not_compared)
    json["not_compared"].push_back(
        {{"preload", one.preload}, {"name", one.name}, {"reason", one.reason}});
  json["settings"] = result.settings;
  json["failed_gates"] = failed_gates;
  return result_json::text(json);
}

}  // namespace cablefit
