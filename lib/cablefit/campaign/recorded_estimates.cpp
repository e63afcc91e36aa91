#include "cablefit/campaign/recorded_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double number_or(const JsonNode& object, std::string_view key, double otherwise) {
  const JsonNode* node = object.find(key);
  return node == nullptr || node->is_null() ? otherwise : node->number();
}

double number_or_none(const JsonNode& object, std::string_view key) {
  return number_or(object, key, kNone);
}

std::string text_or_nothing(const JsonNode& object, std::string_view key) {
  const JsonNode* node = object.find(key);
  return node == nullptr || node->is_null() ? std::string() : node->text();
}

Estimate read_estimate(const JsonNode& node) {
  Estimate e;
  e.name = node.at("name").text();
  e.unit = text_or_nothing(node, "unit");
  e.value = number_or_none(node, "value");
  e.sd = number_or_none(node, "sd");
  const JsonNode* interval = node.find("ci95");
  if (interval != nullptr && interval->is_array()) {
    const std::vector<double> ends = interval->numbers();
    if (ends.size() != 2) throw interval->error("'ci95' has two ends", "give [low, high]");
    e.ci_low = ends[0];
    e.ci_high = ends[1];
  }
  e.profiled = text_or_nothing(node, "interval") == "profile";
  e.not_identifiable = text_or_nothing(node, "not_identifiable");
  e.active_bound = text_or_nothing(node, "active_bound");
  return e;
}

std::vector<Estimate> read_estimates(const JsonNode& list) {
  std::vector<Estimate> estimates;
  for (const JsonNode& node : list.items) estimates.push_back(read_estimate(node));
  return estimates;
}

double half_range(const JsonNode& preload) {
  const JsonNode* range = preload.find("deflection_range");
  if (range == nullptr || range->items.size() != 2 || !range->items[0].is_number()) return kNone;
  return (range->items[1].number() - range->items[0].number()) / 2;
}

/// Rms torque of the motor, from an error that is given both ways.
double motor_torque(const JsonNode& fit) {
  const JsonNode* errors = fit.find("torque_error");
  const JsonNode* motor = errors == nullptr ? nullptr : errors->find("motor");
  if (motor == nullptr) return kNone;
  return number_or_none(*motor, "rms") / number_or_none(*motor, "relative");
}

void add_elastic(const JsonNode& result, std::vector<EstimateSet>& sets) {
  for (const JsonNode& preload : result.at("preloads").items)
    for (const JsonNode& fit : preload.at("fits").items) {
      EstimateSet set{"stage 1", preload.at("name").text(), fit.at("model").text(), ""};
      set.order = static_cast<int>(number_or(fit, "order", 0));
      set.is_selected = text_or_nothing(preload, "selected") == set.model;
      set.torque_scale = number_or_none(preload, "peak_torque");
      set.deflection_scale = half_range(preload);
      set.estimates = read_estimates(fit.at("parameters"));
      sets.push_back(std::move(set));
    }
}

void add_dynamic(const JsonNode& result, std::vector<EstimateSet>& sets) {
  for (const JsonNode& preload : result.at("preloads").items)
    for (const JsonNode& fit : preload.at("fits").items) {
      EstimateSet set{"stage 2", preload.at("name").text(), fit.at("model").text(),
                      text_or_nothing(fit, "estimator")};
      set.torque_scale = motor_torque(fit);
      set.estimates = read_estimates(fit.at("parameters"));
      sets.push_back(std::move(set));
    }
}

void add_identify(const JsonNode& result, std::vector<EstimateSet>& sets) {
  EstimateSet common{"one step", "", "", ""};
  common.estimates = read_estimates(result.at("parameters"));
  sets.push_back(std::move(common));
  for (const JsonNode& preload : result.at("preloads").items) {
    EstimateSet set{"one step", preload.at("name").text(), "", ""};
    set.deflection_scale = half_range(preload);
    set.estimates = read_estimates(preload.at("parameters"));
    sets.push_back(std::move(set));
  }
}

/// Preloads of a campaign go by their cell: two rigs may have the same ones.
void add_batch(const JsonNode& result, std::vector<EstimateSet>& sets) {
  for (const JsonNode& cell : result.at("cells").items) {
    const auto first = static_cast<std::ptrdiff_t>(sets.size());
    const JsonNode* elastic = cell.find("elastic");
    const JsonNode* dynamic = cell.find("dynamic");
    if (elastic != nullptr && elastic->is_object()) add_elastic(*elastic, sets);
    if (dynamic != nullptr && dynamic->is_object()) add_dynamic(*dynamic, sets);
    for (auto set = sets.begin() + first; set != sets.end(); ++set)
      set->preload = cell.at("name").text();
  }
}

struct ResultKind {
  std::string_view schema;
  void (*add)(const JsonNode& result, std::vector<EstimateSet>& sets);
};
constexpr std::array kKinds{
    ResultKind{"cablefit/elastic/1", add_elastic}, ResultKind{"cablefit/dynamic/1", add_dynamic},
    ResultKind{"cablefit/identify/1", add_identify}, ResultKind{"cablefit/batch/1", add_batch}};

const ResultKind& kind_of(const JsonNode& root) {
  const JsonNode& schema = root.at("schema");
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const ResultKind& row) {
    return row.schema == schema.text();
  });
  if (kind == kKinds.end())
    throw schema.error(
        fmt::format("schema {} is not a result with estimates", quoted(schema.text())),
        "give what 'cablefit elastic', 'dynamic', 'identify' or 'batch' wrote");
  return *kind;
}

/// The list of that name, or nothing.
const std::vector<JsonNode>& items_of(const JsonNode& object, std::string_view key) {
  static const std::vector<JsonNode> kNothing;
  const JsonNode* list = object.is_object() ? object.find(key) : nullptr;
  return list == nullptr ? kNothing : list->items;
}

void add_validation_logs(const JsonNode& result, std::set<std::string>& logs) {
  for (const JsonNode& preload : items_of(result, "preloads"))
    if (const JsonNode* validation = preload.find("validation"))
      for (const std::string& path : validation->at("logs").texts()) logs.insert(path);
}

}  // namespace

std::set<std::string> validation_logs(const JsonNode& result) {
  std::set<std::string> logs;
  add_validation_logs(result, logs);
  for (const JsonNode& cell : items_of(result, "cells"))
    if (const JsonNode* dynamic = cell.find("dynamic")) add_validation_logs(*dynamic, logs);
  return logs;
}

RecordedResult read_recorded_result(const std::string& path) {
  const JsonNode root = read_json_file(path);
  RecordedResult result;
  result.path = path;
  kind_of(root).add(root, result.sets);
  result.version = text_or_nothing(root, "cablefit_version");
  result.command = text_or_nothing(root, "command");
  const std::set<std::string> judged = validation_logs(root);
  for (const JsonNode& input : root.at("inputs").items)
    if (!judged.contains(input.at("path").text()))
      result.inputs.push_back({input.at("path").text(), input.at("sha256").text(),
                               static_cast<std::size_t>(input.at("rows").number())});
  return result;
}

}  // namespace cablefit
