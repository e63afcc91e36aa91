#include "cablefit/results/read/elastic_reader.hpp"

#include <fmt/format.h>

#include <optional>

#include "cablefit/base/json/schemas.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/results/read/fit_reader.hpp"
#include "cablefit/results/read/reader_parts.hpp"

namespace cablefit {
namespace {

using namespace result_file;

void read_counts(const JsonNode& node, ElasticPreload& preload) {
  const JsonNode* counts = node.find("counts");
  if (counts == nullptr) return;
  preload.windows = read_window_counts(*counts);
  const JsonNode* equations = counts->find("equations");
  const JsonNode* blocked = equations == nullptr ? nullptr : equations->find("blocked");
  if (blocked != nullptr) preload.counts = read_row_counts(*blocked);
}

void read_modes(const JsonNode& node, ElasticPreload& preload) {
  const JsonNode* modes = node.find("modes");
  if (modes == nullptr) return;
  preload.modes.closure = count_or_zero(*modes, "closure");
  for (const JsonNode& item : items_or_none(*modes, "slack"))
    preload.modes.slack.push_back({item.at("cable").text(), count_or_zero(item, "rows")});
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

/// A rig of several joints has to have as many.
void require_joints(const JsonNode& node, const Rig& rig) {
  if (rig.n_joints() == 1) return;
  const JsonNode& list = node.at("joints");
  if (static_cast<int>(list.items.size()) != rig.n_joints())
    throw list.error(fmt::format("{} joint(s), expected {}", list.items.size(), rig.n_joints()),
                     "the rig has changed since; run `cablefit elastic` again");
}

void read_joints(const JsonNode& node, ElasticPreload& preload) {
  for (const JsonNode& item : items_or_none(node, "joints")) {
    ElasticJoint& joint = preload.joints.emplace_back();
    joint.name = item.at("name").text();
    read_range(item, joint);
    joint.peak_torque = number_or_nan(item, "peak_torque");
    joint.loop_half_width = number_or_nan(item, "loop_half_width");
    joint.weight = number_or_nan(item, "weight");
    joint.both_branches = flag_or(item, "both_branches", true);
    if (const JsonNode* counts = item.find("counts")) joint.counts = read_row_counts(*counts);
  }
}

/// The fit with cables has them; the spring needs them for its reduction.
void take_found_radii(const JsonNode& fits, Transmission& transmission) {
  const SearchedRadii searched = searched_radii(transmission);
  for (const JsonNode& item : fits.items)
    for (const Estimate& e : read_estimates(item.at("parameters")))
      for (std::size_t c = 0; c < transmission.cables.size(); ++c)
        if (searched[c] && e.name == radius_name(transmission.cables[c]) &&
            e.not_identifiable.empty())
          set_motor_radius(transmission, c, *searched[c], e.value);
}

void read_fits(const JsonNode& node, const Rig* rig, ElasticPreload& preload) {
  const JsonNode& fits = node.at("fits");
  if (!fits.is_array() || fits.items.empty()) {
    throw fits.error("no fits", "run `cablefit elastic` again");
  }
  std::optional<Rig> known = rig != nullptr ? std::optional(*rig) : std::nullopt;
  if (known) take_found_radii(fits, known->transmission);
  for (const JsonNode& item : fits.items)
    preload.fits.push_back(read_elastic_fit(item, known ? &*known : nullptr));
}

void read_selection(const JsonNode& node, ElasticPreload& preload) {
  const JsonNode& selected = node.at("selected");
  preload.selected = selected.text();
  preload.shape_doubt = text_or_none(node, "shape_doubt");
  preload.selection = texts_or_none(node, "selection");
  if (preload.find(preload.selected) == nullptr)
    throw selected.error(fmt::format("no fit of model '{:.40}'", preload.selected),
                         "name one of the fits above");
}

ElasticPreload read_preload(const JsonNode& node, RigFiles rig_files) {
  ElasticPreload preload;
  preload.name = node.at("name").text();
  const JsonNode* rig_node = node.find("rig");
  std::optional<Rig> rig;
  if (rig_files == RigFiles::read) rig = model_file::read_rig_reference(rig_node);
  if (rig_node != nullptr && rig_node->is_string()) preload.rig_path = rig_node->text();
  preload.axes = rig ? rig->axes.all() : axes_at(node);
  preload.unit = unit_for(preload.axes, "rad");
  read_range(node, preload);
  if (rig) require_joints(node, *rig);
  read_joints(node, preload);
  read_fits(node, rig ? &*rig : nullptr, preload);
  preload.peak_torque = number_or_nan(node, "peak_torque");
  preload.loop_half_width = number_or_nan(node, "loop_half_width");
  preload.both_branches = flag_or(node, "both_branches", true);
  read_selection(node, preload);
  if (const JsonNode* facts = node.find("rig_content"))
    for (const auto& [name, value] : facts->members)
      preload.rig_facts.push_back({name, value.text()});
  preload.decisions = read_decisions(node);
  preload.warnings = texts_or_none(node, "warnings");
  read_counts(node, preload);
  read_modes(node, preload);
  return preload;
}

}  // namespace

ElasticResult read_elastic_result(const std::string& path) {
  return parse_elastic_result(read_json_file(path));
}

ElasticResult parse_elastic_result(const JsonNode& root, RigFiles rig_files) {
  require_schema(root, kElasticSchema, "a stage-1 result", "elastic");
  ElasticResult result;
  result.inputs = read_inputs(root);
  result.warnings = texts_or_none(root, "warnings");
  const JsonNode& preloads = root.at("preloads");
  if (!preloads.is_array() || preloads.items.empty()) {
    throw preloads.error("no preloads", "run `cablefit elastic` again");
  }
  for (const JsonNode& item : preloads.items)
    result.preloads.push_back(read_preload(item, rig_files));
  return result;
}

}  // namespace cablefit
