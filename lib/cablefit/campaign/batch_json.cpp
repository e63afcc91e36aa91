#include "cablefit/campaign/batch_json.hpp"

#include <nlohmann/json.hpp>

#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "cablefit/results/write/json_list.hpp"
#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;
using result_json::list_of;
using result_json::text_or_null;

Json gap_json(const GapStory& gap) {
  if (!gap.known) return nullptr;
  return Json{{"train_before", gap.train_before},
              {"train_after", gap.train_after},
              {"test_before", gap.test_before},
              {"test_after", gap.test_after},
              {"noise_floor", gap.noise_floor}};
}

Json effect_json(const CellEffect& effect) {
  return Json{{"name", effect.name},
              {"side", effect.side},
              {"torque_rms", effect.torque_rms},
              {"evidence", {{"gain", effect.gain}, {"p_value", effect.p_value}}},
              {"rivals", effect.rivals}};
}

Json refine_json(const CellRefine& refine) {
  Json json{{"verdict", text_or_null(refine.verdict)}, {"reason", text_or_null(refine.reason)}};
  json["effects"] = list_of(refine.effects, effect_json);
  json["gap"] = {{"torque", gap_json(refine.torque)}, {"simulation", gap_json(refine.simulation)}};
  json["next_experiment"] = text_or_null(refine.next_experiment);
  json["error"] = text_or_null(refine.error);
  return json;
}

Json cell_json(const BatchCell& cell) {
  return Json{{"name", cell.name},
              {"robot", text_or_null(cell.robot)},
              {"preload", cell.preload},
              {"date", text_or_null(cell.date)},
              {"error", text_or_null(cell.error)},
              {"elastic", cell.elastic ? Json::parse(elastic_json(*cell.elastic)) : Json()},
              {"dynamic", cell.dynamic ? Json::parse(dynamic_json(*cell.dynamic)) : Json()},
              {"refine", cell.refine ? refine_json(*cell.refine) : Json()}};
}

Json failed_json(const BatchResult& result) {
  Json failed = Json::array();
  for (const BatchCell& cell : result.cells)
    if (!cell.error.empty())
      failed.push_back({{"cell", cell.name}, {"code", cell.exit_code}, {"message", cell.error}});
  return failed;
}

Json gates_json(const BatchResult& result) {
  Json gates = Json::array();
  for (const Gate& gate : result.gates)
    gates.push_back({{"name", gate.name},
                     {"cell", gate.cell},
                     {"limit", gate.limit},
                     {"value", gate.value},
                     {"passed", gate.passed}});
  return gates;
}

std::vector<InputFile> inputs_of(const BatchResult& result) {
  std::vector<InputFile> inputs;
  for (const BatchCell& cell : result.cells) {
    if (cell.elastic)
      inputs.insert(inputs.end(), cell.elastic->inputs.begin(), cell.elastic->inputs.end());
    if (cell.dynamic)
      inputs.insert(inputs.end(), cell.dynamic->inputs.begin(), cell.dynamic->inputs.end());
  }
  return inputs;
}

}  // namespace

std::string batch_json(const BatchResult& result) {
  Json json = result_json::header("batch", inputs_of(result), result.warnings);
  json["campaign"] = {{"path", result.campaign_path}, {"name", result.campaign_name}};
  json["cells"] = list_of(result.cells, cell_json);
  json["failed"] = failed_json(result);
  json["gates"] = gates_json(result);
  return result_json::text(json);
}

}  // namespace cablefit
