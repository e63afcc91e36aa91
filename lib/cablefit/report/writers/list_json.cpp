#include "cablefit/report/writers/list_json.hpp"

#include <nlohmann/json.hpp>

#include "cablefit/results/write/json_parts.hpp"

namespace cablefit {
namespace {

using result_json::Json;

Json table_json(const Table& table) {
  Json rows = Json::array();
  for (const auto& cells : table.rows) {
    Json row = Json::object();
    for (std::size_t k = 0; k < cells.size(); ++k) row[table.columns[k].title] = cells[k];
    rows.push_back(row);
  }
  return Json{{"title", table.title}, {"rows", rows}};
}

}  // namespace

std::string list_json(const std::vector<ListSection>& sections) {
  Json json = result_json::header("list", {}, {});
  for (const ListSection& section : sections) {
    json[section.name] = Json::array();
    for (const Table& table : section.tables) json[section.name].push_back(table_json(table));
  }
  return result_json::text(json);
}

}  // namespace cablefit
