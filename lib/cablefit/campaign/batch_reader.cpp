#include "cablefit/campaign/batch_reader.hpp"

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/results/read/dynamic_reader.hpp"
#include "cablefit/results/read/reader_parts.hpp"

namespace cablefit {
namespace {

BatchCell read_cell(const JsonNode& node) {
  BatchCell cell;
  cell.name = node.at("name").text();
  cell.robot = result_file::text_or_none(node, "robot");
  cell.preload = result_file::text_or_none(node, "preload");
  if (cell.preload.empty()) cell.preload = cell.name;
  cell.date = result_file::text_or_none(node, "date");
  cell.error = result_file::text_or_none(node, "error");
  if (const JsonNode* elastic = result_file::object_or_none(node, "elastic"))
    cell.elastic = parse_elastic_result(*elastic, RigFiles::leave);
  if (const JsonNode* dynamic = result_file::object_or_none(node, "dynamic"))
    cell.dynamic = parse_dynamic_result(*dynamic, RigFiles::leave);
  return cell;
}

}  // namespace

std::vector<BatchCell> parse_batch_cells(const JsonNode& root) {
  std::vector<BatchCell> cells;
  for (const JsonNode& item : root.at("cells").items) cells.push_back(read_cell(item));
  return cells;
}

}  // namespace cablefit
