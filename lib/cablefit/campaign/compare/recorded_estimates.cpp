#include "cablefit/campaign/compare/recorded_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "cablefit/base/json/schemas.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/batch_reader.hpp"
#include "cablefit/results/read/dynamic_reader.hpp"
#include "cablefit/results/read/identify_reader.hpp"
#include "cablefit/results/read/reader_parts.hpp"

namespace cablefit {
namespace {

using result_file::items_or_none;
using Sets = std::vector<EstimateSet>;

/// Rms torque of the motor, from an error that is given both ways.
double motor_torque(const DynamicFit& fit) {
  const auto motor = fit.torque_error.find("motor");
  if (motor == fit.torque_error.end()) return std::numeric_limits<double>::quiet_NaN();
  return motor->second.rms / motor->second.relative;
}

void add_elastic(const ElasticResult& result, Sets& sets) {
  for (const ElasticPreload& preload : result.preloads)
    for (const ElasticFit& fit : preload.fits) {
      EstimateSet set{"stage 1", preload.name, fit.model, ""};
      set.order = fit.order;
      set.is_selected = preload.selected == fit.model;
      set.torque_scale = preload.peak_torque;
      set.deflection_scale = (preload.deflection_high - preload.deflection_low) / 2;
      set.estimates = fit.parameters;
      sets.push_back(std::move(set));
    }
}

void add_dynamic(const DynamicResult& result, Sets& sets) {
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits) {
      EstimateSet set{"stage 2", preload.name, fit.model, fit.estimator};
      set.torque_scale = motor_torque(fit);
      set.estimates = fit.parameters;
      sets.push_back(std::move(set));
    }
}

void add_identify(const IdentifyResult& result, Sets& sets) {
  EstimateSet common{"one step", "", "", ""};
  common.estimates = result.parameters;
  sets.push_back(std::move(common));
  for (const IdentifyPreload& preload : result.preloads) {
    EstimateSet set{"one step", preload.name, "", ""};
    set.deflection_scale = (preload.deflection_high - preload.deflection_low) / 2;
    set.estimates = preload.parameters;
    sets.push_back(std::move(set));
  }
}

/// Preloads of a campaign go by their cell: two rigs may have the same ones.
void add_batch(const JsonNode& root, Sets& sets) {
  for (const BatchCell& cell : parse_batch_cells(root)) {
    const auto first = static_cast<std::ptrdiff_t>(sets.size());
    if (cell.elastic) add_elastic(*cell.elastic, sets);
    if (cell.dynamic) add_dynamic(*cell.dynamic, sets);
    for (auto set = sets.begin() + first; set != sets.end(); ++set) set->preload = cell.name;
  }
}

struct ResultKind {
  std::string_view schema;
  void (*add)(const JsonNode& root, Sets& sets);
};
constexpr std::array kKinds{
    ResultKind{kElasticSchema,
               [](const JsonNode& root, Sets& sets) {
                 add_elastic(parse_elastic_result(root, RigFiles::leave), sets);
               }},
    ResultKind{kDynamicSchema,
               [](const JsonNode& root, Sets& sets) {
                 add_dynamic(parse_dynamic_result(root, RigFiles::leave), sets);
               }},
    ResultKind{kIdentifySchema,
               [](const JsonNode& root, Sets& sets) {
                 add_identify(parse_identify_result(root, RigFiles::leave), sets);
               }},
    ResultKind{kBatchSchema, add_batch}};

const ResultKind& kind_of(const JsonNode& root) {
  const JsonNode& schema = root.at("schema");
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const ResultKind& row) {
    return row.schema == schema.text();
  });
  if (kind == kKinds.end())
    throw schema.error(
        fmt::format("schema {} is not a result with estimates", in_quotes(schema.text())),
        "give what 'cablefit elastic', 'dynamic', 'identify' or 'batch' wrote");
  return *kind;
}

void add_validation_logs(const JsonNode& result, std::set<std::string>& logs) {
  if (!result.is_object()) return;
  for (const JsonNode& preload : items_or_none(result, "preloads"))
    if (const JsonNode* validation = preload.find("validation"))
      for (const std::string& path : validation->at("logs").texts()) logs.insert(path);
}

}  // namespace

std::set<std::string> validation_logs(const JsonNode& result) {
  std::set<std::string> logs;
  add_validation_logs(result, logs);
  for (const JsonNode& cell : items_or_none(result, "cells"))
    if (const JsonNode* dynamic = cell.find("dynamic")) add_validation_logs(*dynamic, logs);
  return logs;
}

RecordedResult read_recorded_result(const std::string& path) {
  const JsonNode root = read_json_file(path);
  RecordedResult result;
  result.path = path;
  kind_of(root).add(root, result.sets);
  (void)root.at("inputs");
  result.version = result_file::text_or_none(root, "cablefit_version");
  result.command = result_file::text_or_none(root, "command");
  const std::set<std::string> judged = validation_logs(root);
  for (InputFile& input : result_file::read_inputs(root))
    if (!judged.contains(input.path)) result.inputs.push_back(std::move(input));
  return result;
}

}  // namespace cablefit
