#include "cablefit/results/read/dynamic_reader.hpp"

#include <array>
#include <optional>
#include <utility>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/json/schemas.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read/fit_reader.hpp"
#include "cablefit/results/read/proof_reader.hpp"
#include "cablefit/results/read/reader_parts.hpp"
#include "cablefit/results/read/validation_reader.hpp"

namespace cablefit {
namespace {

using namespace result_file;

std::map<std::string, TorqueError> read_torque_errors(const JsonNode& node) {
  std::map<std::string, TorqueError> errors;
  if (const JsonNode* given = object_or_none(node, "torque_error"))
    for (const auto& [equation, error] : given->members)
      errors[equation] = {number_or_nan(error, "rms"), number_or_nan(error, "max_abs"),
                          number_or_nan(error, "relative")};
  return errors;
}

std::vector<SuspectSpan> read_suspects(const JsonNode& node) {
  std::vector<SuspectSpan> spans;
  for (const JsonNode& item : items_or_none(node, "suspects"))
    spans.push_back({item.at("equation").text(), item.at("log").text(), item.at("run").text(),
                     number_or_nan(item, "from"), number_or_nan(item, "to"),
                     number_or_nan(item, "largest"), count_or_zero(item, "rows")});
  return spans;
}

std::optional<Sweep> read_sweep(const JsonNode& node) {
  const JsonNode* given = object_or_none(node, "sweep");
  if (given == nullptr) return std::nullopt;
  Sweep sweep;
  sweep.parameters = texts_or_none(*given, "parameters");
  for (const JsonNode& item : items_or_none(*given, "points")) {
    SweepPoint& point = sweep.points.emplace_back();
    point.setting = item.at("setting").text();
    point.factor = number_or_nan(item, "factor");
    point.value = number_or_nan(item, "value");
    point.change = numbers_or_nan(item, "change_in_sd");
  }
  for (const JsonNode& item : items_or_none(*given, "verdicts"))
    sweep.verdicts.push_back(
        {item.at("setting").text(), text_or_none(item, "verdict"), flag_or(item, "flat", true)});
  return sweep;
}

ElasticFit read_stage1(const JsonNode& node, const JsonNode& fit_node, const Rig& rig,
                       const std::string& model) {
  ElasticFit fit;
  fit.model = model;
  fit.order = read_order(node);
  fit.parameters = read_estimates(node.at("parameters"));
  read_curve(node, rig, {&fit_node, "the fit's \"elastic\" object needs it"}, fit);
  return fit;
}

TorqueDelay read_delay(const JsonNode& node) {
  TorqueDelay delay;
  const JsonNode* given = node.find("torque_delay");
  if (given == nullptr) return delay;
  delay.held = given->at("held").boolean();
  delay.reason = text_or_none(*given, "reason");
  if (const JsonNode* period = given->find("period")) delay.period = period->positive();
  delay.estimated = given->find("seconds") != nullptr && !given->at("seconds").is_null();
  if (!delay.estimated) return delay;
  delay.seconds = number_or_nan(*given, "seconds");
  delay.sd = number_or_nan(*given, "sd");
  return delay;
}

void read_systematic(const JsonNode& node, DynamicFit& fit) {
  const JsonNode* systematic = object_or_none(node, "systematic");
  if (systematic == nullptr) return;
  fit.method_floor = numbers_by_name(*systematic, "method_floor");
  fit.estimator_difference = numbers_by_name(*systematic, "estimator_difference");
  fit.stage1_misfit = numbers_by_name(*systematic, "stage1_misfit");
}

/// What needs the cables of the rig.
void read_model_parts(const JsonNode& node, const Rig& rig, DynamicFit& fit) {
  if (const JsonNode* elastic = node.find("elastic"); elastic != nullptr && !elastic->is_null())
    fit.elastic = read_stage1(*elastic, node, rig, fit.model);
  const JsonNode* effects = node.find("effects");
  if (effects != nullptr && !effects->items.empty())
    fit.effects = model_file::read_effects_per_joint(*effects, rig, is_rigid_fit(fit, rig));
  const JsonNode* covariance = node.find("covariance");
  if (covariance != nullptr && !covariance->is_null())
    fit.covariance = model_file::read_covariance(*covariance);
}

}  // namespace

bool is_rigid_fit(const DynamicFit& fit, const Rig& rig) {
  const std::string_view inertia = base_effects(Side::rigid).front().parameters.front().name;
  return find_estimate(fit.parameters, joint_parameter_name(inertia, 1, rig.n_joints())) != nullptr;
}

DynamicFit read_dynamic_fit(const JsonNode& node, const Rig* rig) {
  DynamicFit fit;
  fit.model = node.at("model").text();
  fit.estimator = text_or_none(node, "estimator");
  fit.parameters = read_estimates(node.at("parameters"));
  if (const JsonNode* derived = node.find("derived")) fit.derived = read_estimates(*derived);
  fit.torque_error = read_torque_errors(node);
  fit.weight = numbers_by_name(node, "weight");
  fit.condition = numbers_by_name(node, "condition");
  fit.effective_rows = numbers_by_name(node, "effective_rows");
  fit.sd_reason = texts_by_name(node, "sd_reason");
  fit.verdicts = texts_by_name(node, "verdicts");
  read_systematic(node, fit);
  fit.suspects = read_suspects(node);
  fit.sweep = read_sweep(node);
  fit.proof = read_proof(node);
  fit.warnings = texts_or_none(node, "warnings");
  if (rig != nullptr) read_model_parts(node, *rig, fit);
  return fit;
}

DynamicPreload read_dynamic_preload(const JsonNode& node) {
  DynamicPreload preload;
  preload.name = node.at("name").text();
  if (const JsonNode* rig = node.find("rig"); rig != nullptr && rig->is_string())
    preload.rig_path = rig->text();
  preload.axes = axes_at(node);
  if (object_or_none(node, "counts") != nullptr) {
    const JsonNode& counts = node.at("counts");
    preload.windows = read_window_counts(counts);
    if (const JsonNode* equations = object_or_none(counts, "equations"))
      for (const auto& [equation, rows] : equations->members)
        preload.counts[equation] = read_row_counts(rows);
  }
  if (const JsonNode* f0 = node.find("resonance_hz"); f0 != nullptr && !f0->is_null())
    preload.resonance = f0->number();
  if (node.find("load_inertia") != nullptr)
    preload.load_inertia = number_or_nan(node, "load_inertia");
  preload.delay = read_delay(node);
  preload.decisions = read_decisions(node);
  preload.warnings = texts_or_none(node, "warnings");
  preload.residual_tests = read_residual_tests(node);
  if (const JsonNode* validation = object_or_none(node, "validation"))
    preload.validation = read_validation(*validation);
  return preload;
}

DynamicResult parse_dynamic_result(const JsonNode& root, RigFiles rig_files) {
  require_schema(root, kDynamicSchema, "a stage-2 result", "dynamic");
  DynamicResult result;
  result.inputs = read_inputs(root);
  result.warnings = texts_or_none(root, "warnings");
  for (const JsonNode& node : root.at("preloads").items) {
    DynamicPreload& preload = result.preloads.emplace_back(read_dynamic_preload(node));
    std::optional<Rig> rig;
    if (rig_files == RigFiles::read) rig = model_file::read_rig_reference(node.find("rig"));
    for (const JsonNode& fit : node.at("fits").items)
      preload.fits.push_back(read_dynamic_fit(fit, rig ? &*rig : nullptr));
  }
  return result;
}

}  // namespace cablefit
