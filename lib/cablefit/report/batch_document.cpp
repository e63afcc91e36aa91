#include "cablefit/report/batch_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cablefit/report/batch_figures.hpp"
#include "cablefit/report/document_parts.hpp"
#include "cablefit/report/dynamic_document.hpp"
#include "cablefit/report/dynamic_json.hpp"
#include "cablefit/report/elastic_document.hpp"
#include "cablefit/report/elastic_json.hpp"
#include "cablefit/report/json_parts.hpp"
#include "cablefit/report/numbers.hpp"

namespace cablefit {
namespace {

void append(Document& all, const Document& part) {
  all.tables.insert(all.tables.end(), part.tables.begin(), part.tables.end());
  all.paragraphs.insert(all.paragraphs.end(), part.paragraphs.begin(), part.paragraphs.end());
  all.decisions.insert(all.decisions.end(), part.decisions.begin(), part.decisions.end());
  add_figures(all, part.figures);
  all.warnings.insert(all.warnings.end(), part.warnings.begin(), part.warnings.end());
  if (all.tidy.columns.empty()) {
    all.tidy = part.tidy;
  } else {
    all.tidy.rows.insert(all.tidy.rows.end(), part.tidy.rows.begin(), part.tidy.rows.end());
  }
}

Table gate_table(const BatchResult& result) {
  Table table;
  table.title = "Gates";
  table.columns = {{"", "preload", "", true},
                   {"", "gate", "", true},
                   {"", "limit", "", false},
                   {"", "value", "", false},
                   {"", "", "", true}};
  for (const Gate& gate : result.gates)
    table.rows.push_back({gate.cell, gate.name, fmt::format("{:.4g}", gate.limit),
                          fmt::format("{:.4g}", gate.value), gate.passed ? "passed" : "FAILED"});
  table.detail = true;
  return table;
}

std::string gate_summary(const BatchResult& result) {
  const auto failed = std::count_if(result.gates.begin(), result.gates.end(),
                                    [](const Gate& gate) { return !gate.passed; });
  return fmt::format("Gates: {} checked, {} failed.", result.gates.size(), failed);
}

nlohmann::ordered_json gates_json(const BatchResult& result) {
  auto gates = nlohmann::ordered_json::array();
  for (const Gate& gate : result.gates)
    gates.push_back({{"name", gate.name},
                     {"cell", gate.cell},
                     {"limit", gate.limit},
                     {"value", gate.value},
                     {"passed", gate.passed}});
  return gates;
}

}  // namespace

Document batch_document(const BatchResult& result) {
  Document document;
  document.title = result.campaign_name.empty() ? "Campaign" : result.campaign_name;
  const ElasticResult elastic = result.all_elastic();
  const DynamicResult dynamic = result.all_dynamic();
  document.figures = parameter_figures(elastic, dynamic);
  append(document, elastic_document(elastic));
  append(document, dynamic_document(dynamic));
  for (const BatchCell& cell : result.cells)
    if (!cell.error.empty())
      document.warnings.push_back(fmt::format("{}: {}", cell.name, cell.error));
  if (result.gates.empty()) return document;
  document.tables.push_back(gate_table(result));
  document.paragraphs.push_back(gate_summary(result));
  for (const Gate& gate : result.gates)
    if (!gate.passed) document.paragraphs.push_back(gate.text);
  return document;
}

std::string batch_json(const BatchResult& result) {
  using report_json::Json;
  const ElasticResult elastic = result.all_elastic();
  const DynamicResult dynamic = result.all_dynamic();
  std::vector<InputFile> inputs = elastic.inputs;
  inputs.insert(inputs.end(), dynamic.inputs.begin(), dynamic.inputs.end());
  Json json = report_json::header("batch", inputs, {});
  json["campaign"] = {{"path", result.campaign_path}, {"name", result.campaign_name}};
  json["cells"] = Json::array();
  for (const BatchCell& cell : result.cells) {
    Json entry = {{"name", cell.name}};
    entry["error"] = cell.error.empty() ? Json(nullptr) : Json(cell.error);
    entry["elastic"] = cell.elastic ? Json::parse(elastic_json(*cell.elastic)) : Json(nullptr);
    entry["dynamic"] = cell.dynamic ? Json::parse(dynamic_json(*cell.dynamic)) : Json(nullptr);
    json["cells"].push_back(std::move(entry));
  }
  json["gates"] = gates_json(result);
  return report_json::text(json);
}

}  // namespace cablefit
