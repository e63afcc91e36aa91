#include "cablefit/results/read/identify_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/json/schemas.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"
#include "cablefit/results/read/fit_reader.hpp"
#include "cablefit/results/read/reader_parts.hpp"

namespace cablefit {
namespace {

using namespace result_file;

double bound_or(const JsonNode& node, std::string_view key, double otherwise) {
  const double value = number_or_nan(node, key);
  return value == value ? value : otherwise;
}

std::vector<IdentifyEquation> read_equations(const JsonNode& node) {
  std::vector<IdentifyEquation> equations;
  const JsonNode* given = object_or_none(node, "equations");
  if (given == nullptr) return equations;
  for (const auto& [name, e] : given->members) {
    const std::string side = name.substr(0, name.find('['));
    const JsonNode* counts = object_or_none(e, "counts");
    equations.push_back({name, side, counts ? read_row_counts(*counts) : RowCounts{},
                         number_or_nan(e, "rms"), number_or_nan(e, "weight"),
                         number_or_nan(e, "effective_rows")});
  }
  return equations;
}

LineStiffness read_line(const JsonNode& node, std::string name) {
  const std::vector<double> range = n_numbers(node.at("range"), 2);
  return {std::move(name),
          range[0],
          range[1],
          number_or_nan(node, "measured"),
          number_or_nan(node, "sd"),
          number_or_nan(node, "model")};
}

/// Of one joint its line, of several a list with names.
std::vector<LineStiffness> read_lines(const JsonNode& node) {
  std::vector<LineStiffness> lines;
  if (const JsonNode* line = object_or_none(node, "linear_K")) return {read_line(*line, "K")};
  for (const JsonNode& item : items_or_none(node, "linear_K"))
    lines.push_back(read_line(item, item.at("name").text()));
  return lines;
}

std::vector<SlackPoint> read_slack(const JsonNode& node) {
  const std::vector<JsonNode>& cables = items_or_none(node, "cables");
  std::vector<SlackPoint> points;
  for (const JsonNode& item : items_or_none(node, "slack_points")) {
    const JsonNode& name = item.at("cable");
    const auto cable = std::find_if(cables.begin(), cables.end(), [&](const JsonNode& one) {
      return one.at("name").text() == name.text();
    });
    if (cable == cables.end())
      throw name.error(fmt::format("no cable {}", in_quotes(name.text())),
                       "name one of \"cables\"");
    SlackPoint& point = points.emplace_back();
    point.cable = static_cast<std::size_t>(cable - cables.begin());
    point.deflection = number_or_nan(item, "deflection");
    point.link = number_or_nan(item, "link_torque");
    point.motor = number_or_nan(item, "motor_torque");
    point.slack_above = text_or_none(item, "slack") == "above";
  }
  return points;
}

/// The fitted cables, and the model where the dynamics were identified. `shared`: parameters of all
/// preloads.
void read_cables(const JsonNode& node, const std::vector<Estimate>& shared,
                 IdentifyPreload& preload) {
  if (const JsonNode* model = object_or_none(node, "model")) {
    std::string choice;
    preload.model = model_file::read_model_file(*model, {}, &choice);
    preload.transmission = preload.model->transmission;
    return;
  }
  ElasticFit curve;
  curve.parameters = shared;
  curve.parameters.insert(curve.parameters.end(), preload.parameters.begin(),
                          preload.parameters.end());
  read_curve(node, model_file::read_rig_reference(node.find("rig")),
             {&node, "run `cablefit identify` again"}, curve);
  preload.transmission = curve.transmission;
}

IdentifyPreload read_preload(const JsonNode& node) {
  IdentifyPreload preload;
  preload.name = node.at("name").text();
  preload.rig_path = text_or_none(node, "rig");
  preload.parameters = read_estimates(node.at("parameters"));
  if (const JsonNode* derived = node.find("derived")) preload.derived = read_estimates(*derived);
  if (const JsonNode* range = node.find("deflection_range")) {
    const std::vector<double> ends = n_numbers(*range, 2);
    preload.deflection_low = ends[0];
    preload.deflection_high = ends[1];
  }
  preload.equilibrium = number_or_nan(node, "equilibrium_torque");
  preload.lines = read_lines(node);
  preload.slack = read_slack(node);
  preload.equations = read_equations(node);
  preload.resonance = bound_or(node, "resonance_hz", 0);
  if (node.find("load_inertia") != nullptr)
    preload.load_inertia = number_or_nan(node, "load_inertia");
  preload.decisions = read_decisions(node);
  preload.warnings = texts_or_none(node, "warnings");
  return preload;
}

ElongationProfile read_profile(const JsonNode& node) {
  return {text_or_none(node, "preload"),      text_or_none(node, "name"),
          text_or_none(node, "unit"),         node.at("l_o").numbers(),
          node.at("deviance").numbers(),      number_or_nan(node, "threshold"),
          bound_or(node, "low", -kUnbounded), bound_or(node, "high", kUnbounded)};
}

}  // namespace

IdentifyResult parse_identify_result(const JsonNode& root, RigFiles rig_files) {
  require_schema(root, kIdentifySchema, "a result of one step", "identify");
  IdentifyResult result;
  result.inputs = read_inputs(root);
  result.warnings = texts_or_none(root, "warnings");
  result.parameters = read_estimates(root.at("parameters"));
  for (const JsonNode& item : root.at("preloads").items) {
    result.preloads.push_back(read_preload(item));
    if (rig_files == RigFiles::read) read_cables(item, result.parameters, result.preloads.back());
  }
  for (const JsonNode& item : items_or_none(root, "profiles"))
    result.profiles.push_back(read_profile(item));
  result.active_bounds = texts_or_none(root, "active_bounds");
  result.condition = number_or_nan(root, "condition");
  result.decisions = read_decisions(root);
  return result;
}

}  // namespace cablefit
