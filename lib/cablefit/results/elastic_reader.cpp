#include "cablefit/results/elastic_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/results/fit_reader.hpp"

namespace cablefit {
namespace {

constexpr std::string_view kSchema = "cablefit/elastic/1";

void require_schema(const JsonNode& root) {
  const JsonNode& schema = root.at("schema");
  if (schema.text() == kSchema) return;
  throw schema.error(fmt::format("schema '{:.60}' is not a stage-1 result", schema.text()),
                     fmt::format("expected '{}', as `cablefit elastic` writes it", kSchema));
}

std::size_t count(const JsonNode& object, std::string_view key) {
  const JsonNode* node = object.find(key);
  if (node == nullptr) return 0;
  const double value = node->number();
  if (value >= 0 && value == std::floor(value)) return static_cast<std::size_t>(value);
  throw node->error(fmt::format("{} is not a count", value), "write a whole number of rows");
}

std::vector<std::string> texts(const JsonNode& object, std::string_view key) {
  const JsonNode* node = object.find(key);
  return node == nullptr ? std::vector<std::string>{} : node->texts();
}

std::vector<InputFile> read_inputs(const JsonNode& root) {
  std::vector<InputFile> inputs;
  const JsonNode* list = root.find("inputs");
  if (list == nullptr) return inputs;
  for (const JsonNode& item : list->items) {
    inputs.push_back({item.at("path").text(), item.at("sha256").text(), count(item, "rows")});
  }
  return inputs;
}

std::vector<Decision> read_decisions(const JsonNode& node) {
  std::vector<Decision> decisions;
  const JsonNode* list = node.find("decisions");
  if (list == nullptr) return decisions;
  for (const JsonNode& item : list->items) {
    decisions.push_back(
        {item.at("name").text(), item.at("value").text(), item.at("reason").text()});
  }
  return decisions;
}

RowCounts read_row_counts(const JsonNode& node) {
  return {count(node, "rows_used"), count(node, "rows_at_rest"), count(node, "rows_not_used"),
          count(node, "rows_at_edges")};
}

void read_counts(const JsonNode& node, ElasticPreload& preload) {
  const JsonNode* counts = node.find("counts");
  if (counts == nullptr) return;
  preload.windows = {count(*counts, "rows_read"), count(*counts, "rows_resampled"),
                     count(*counts, "rows_too_short"), count(*counts, "segments")};
  const JsonNode* equations = counts->find("equations");
  const JsonNode* blocked = equations == nullptr ? nullptr : equations->find("blocked");
  if (blocked == nullptr) return;
  preload.counts = read_row_counts(*blocked);
}

void read_modes(const JsonNode& node, ElasticPreload& preload) {
  const JsonNode* modes = node.find("modes");
  if (modes == nullptr) return;
  preload.modes.closure = count(*modes, "closure");
  if (const JsonNode* slack = modes->find("slack"))
    for (const JsonNode& item : slack->items)
      preload.modes.slack.push_back({item.at("cable").text(), count(item, "rows")});
}

/// Of a preload or of one of its joints.
template <typename Deflected>
void read_range(const JsonNode& node, Deflected& preload) {
  const JsonNode& range = node.at("deflection_range");
  const std::vector<double> ends = range.numbers();
  if (ends.size() != 2 || ends[0] > ends[1]) {
    throw range.error("not a range", "write it as [lowest, highest]");
  }
  preload.deflection_low = ends[0];
  preload.deflection_high = ends[1];
}

/// Of a rig of several joints, which has to have as many.
void read_joints(const JsonNode& node, int n_joints, ElasticPreload& preload) {
  if (n_joints == 1) return;
  const JsonNode& list = node.at("joints");
  if (static_cast<int>(list.items.size()) != n_joints)
    throw list.error(fmt::format("{} joint(s), expected {}", list.items.size(), n_joints),
                     "the rig has changed since; run `cablefit elastic` again");
  for (const JsonNode& item : list.items) {
    ElasticJoint& joint = preload.joints.emplace_back();
    joint.name = item.at("name").text();
    read_range(item, joint);
    joint.peak_torque = number_or_nan(item, "peak_torque");
    joint.loop_half_width = number_or_nan(item, "loop_half_width");
    joint.weight = number_or_nan(item, "weight");
    if (const JsonNode* branches = item.find("both_branches"))
      joint.both_branches = branches->boolean();
    if (const JsonNode* counts = item.find("counts")) joint.counts = read_row_counts(*counts);
  }
}

void read_fits(const JsonNode& node, const Rig& rig, ElasticPreload& preload) {
  const JsonNode& fits = node.at("fits");
  if (!fits.is_array() || fits.items.empty()) {
    throw fits.error("no fits", "run `cablefit elastic` again");
  }
  for (const JsonNode& item : fits.items) preload.fits.push_back(read_elastic_fit(item, rig));
}

ElasticPreload read_preload(const JsonNode& node) {
  ElasticPreload preload;
  preload.name = node.at("name").text();
  const JsonNode* rig_node = node.find("rig");
  const Rig rig = model_file::read_rig_reference(rig_node);
  if (rig_node != nullptr && rig_node->is_string()) preload.rig_path = rig_node->text();
  preload.linear_motion = rig.linear_motion;
  preload.unit = rig.linear_motion ? "m" : "rad";
  read_range(node, preload);
  read_joints(node, rig.n_joints(), preload);
  read_fits(node, rig, preload);
  preload.peak_torque = number_or_nan(node, "peak_torque");
  preload.loop_half_width = number_or_nan(node, "loop_half_width");
  if (const JsonNode* branches = node.find("both_branches")) {
    preload.both_branches = branches->boolean();
  }
  const JsonNode& selected = node.at("selected");
  preload.selected = selected.text();
  if (const JsonNode* doubt = node.find("shape_doubt")) preload.shape_doubt = doubt->text();
  if (preload.find(preload.selected) == nullptr) {
    throw selected.error(fmt::format("no fit of model '{:.40}'", preload.selected),
                         "name one of the fits above");
  }
  if (const JsonNode* facts = node.find("rig_content"))
    for (const auto& [name, value] : facts->members)
      preload.rig_facts.push_back({name, value.text()});
  preload.selection = texts(node, "selection");
  preload.decisions = read_decisions(node);
  preload.warnings = texts(node, "warnings");
  read_counts(node, preload);
  read_modes(node, preload);
  return preload;
}

}  // namespace

double number_or_nan(const JsonNode& object, std::string_view key) {
  const JsonNode* node = object.find(key);
  if (node == nullptr || node->is_null()) return std::numeric_limits<double>::quiet_NaN();
  return node->number();
}

ElasticResult read_elastic_result(const std::string& path) {
  return parse_elastic_result(read_json_file(path));
}

ElasticResult parse_elastic_result(const JsonNode& root) {
  require_schema(root);
  ElasticResult result;
  result.inputs = read_inputs(root);
  result.warnings = texts(root, "warnings");
  const JsonNode& preloads = root.at("preloads");
  if (!preloads.is_array() || preloads.items.empty()) {
    throw preloads.error("no preloads", "run `cablefit elastic` again");
  }
  for (const JsonNode& item : preloads.items) result.preloads.push_back(read_preload(item));
  return result;
}

}  // namespace cablefit
