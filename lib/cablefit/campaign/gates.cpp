#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/base/json_document.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/batch.hpp"
#include "cablefit/model/effects.hpp"

namespace cablefit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Whether a percentage of the parameter's value says anything.
bool is_physical(std::string_view name) {
  for (const Effect& effect : effects())
    for (const ParameterInfo& info : effect.parameters)
      if (info.name == name) return std::isfinite(info.lower);
  return false;
}

/// The fit that the gates look at: stage 1's choice when it was fitted, else the last (richest).
const DynamicFit* gated_fit(const BatchCell& cell, const DynamicPreload& preload) {
  if (preload.fits.empty()) return nullptr;
  for (const ElasticPreload& stage1 : cell.elastic->preloads)
    if (stage1.name == preload.name)
      for (const DynamicFit& fit : preload.fits)
        if (fit.model == stage1.selected) return &fit;
  return &preload.fits.back();
}

Gate gate(std::string name, const BatchCell& cell, double limit, double value,
          std::string_view unit) {
  Gate g{std::move(name), cell.name, limit, value, value <= limit, ""};
  g.text = fmt::format("{}: {}: {} is {:.4g} {}, limit {:.4g} {}", g.passed ? "passed" : "FAILED",
                       cell.name, g.name, value, unit, limit, unit);
  return g;
}

void judge_rsd(const BatchCell& cell, const DynamicFit& fit, double limit,
               std::vector<Gate>& gates) {
  for (const Estimate& e : fit.parameters)
    if (is_physical(e.name))
      gates.push_back(gate("rsd_percent " + e.name, cell, limit, e.rsd_percent(), "%"));
}

void judge_error(const BatchCell& cell, const DynamicPreload& preload, const DynamicFit& fit,
                 double limit, std::vector<Gate>& gates) {
  for (const auto& [equation, error] : fit.torque_error)
    gates.push_back(gate("torque_error " + equation, cell, limit, error.rms,
                         preload.linear_motion ? "N" : "N m"));
}

/// value of parameter `name` in the fit of `model` for `preload` of a batch result, NaN when not
/// there.
double baseline_value(const JsonNode& cells, std::string_view stage, const std::string& preload,
                      const std::string& model, const std::string& name) {
  for (const JsonNode& cell : cells.items) {
    const JsonNode* result = cell.find(stage);
    if (result == nullptr || !result->is_object()) continue;
    for (const JsonNode& p : result->at("preloads").items) {
      if (p.at("name").text() != preload) continue;
      for (const JsonNode& fit : p.at("fits").items) {
        if (fit.at("model").text() != model) continue;
        for (const JsonNode& parameter : fit.at("parameters").items)
          if (parameter.at("name").text() == name && parameter.at("value").is_number())
            return parameter.at("value").number();
      }
    }
  }
  return kNone;
}

Gate drift_gate(const BatchCell& cell, const std::string& name, double value, double baseline,
                double limit) {
  const double drift = 100 * std::abs(value - baseline) / std::abs(baseline);
  Gate g{"drift " + name, cell.name, limit, drift, drift <= limit, ""};
  if (std::isnan(baseline)) {
    g.text = fmt::format("FAILED: {}: drift {}: the baseline does not have it", cell.name, name);
  } else {
    g.text =
        fmt::format("{}: {}: drift of {} is {:.3g} % ({:.5g} against {:.5g}), limit {:.4g} %",
                    g.passed ? "passed" : "FAILED", cell.name, name, drift, value, baseline, limit);
  }
  return g;
}

void judge_drift(const Campaign& campaign, const JsonNode& baseline, const BatchCell& cell,
                 std::vector<Gate>& gates) {
  const JsonNode& cells = baseline.at("cells");
  const double limit = campaign.limits.drift_percent;
  for (const ElasticPreload& preload : cell.elastic->preloads)
    if (const ElasticFit* line = preload.find("linear"))
      if (const Estimate* k = find_estimate(line->parameters, "K"))
        gates.push_back(
            drift_gate(cell, k->name, k->value,
                       baseline_value(cells, "elastic", preload.name, "linear", k->name), limit));
  if (!cell.dynamic) return;
  for (const DynamicPreload& preload : cell.dynamic->preloads)
    if (const DynamicFit* fit = gated_fit(cell, preload))
      for (const Estimate& e : fit->parameters)
        if (is_physical(e.name))
          gates.push_back(drift_gate(
              cell, e.name, e.value,
              baseline_value(cells, "dynamic", preload.name, fit->model, e.name), limit));
}

/// What could not be fitted has not met its limits.
Gate missing_gate(const BatchCell& cell) {
  return {"fitted", cell.name, kNone,
          kNone,    false,     fmt::format("FAILED: {}: could not be fitted", cell.name)};
}

JsonNode read_baseline(const std::string& path) {
  JsonNode root = read_json_file(path);
  const JsonNode& schema = root.at("schema");
  if (schema.text() != "cablefit/batch/1")
    throw schema.error(
        fmt::format("'schema' is {}, not a batch result", cablefit::quoted(schema.text())),
        "keep the batch.json of a good run as the baseline");
  return root;
}

}  // namespace

void check_baseline(const Campaign& campaign) {
  const std::string& path = campaign.limits.drift_baseline;
  if (!path.empty()) read_baseline(path);
}

std::vector<Gate> judge(const Campaign& campaign, const std::vector<BatchCell>& cells) {
  std::vector<Gate> gates;
  const CampaignLimits& limits = campaign.limits;
  JsonNode baseline;
  if (!limits.drift_baseline.empty()) baseline = read_baseline(limits.drift_baseline);
  for (const BatchCell& cell : cells) {
    if (!cell.error.empty() || !cell.elastic) {
      gates.push_back(missing_gate(cell));
      continue;
    }
    if (cell.dynamic)
      for (const DynamicPreload& preload : cell.dynamic->preloads) {
        const DynamicFit* fit = gated_fit(cell, preload);
        if (fit == nullptr) continue;
        if (limits.rsd_percent) judge_rsd(cell, *fit, *limits.rsd_percent, gates);
        if (limits.torque_error) judge_error(cell, preload, *fit, *limits.torque_error, gates);
      }
    if (!limits.drift_baseline.empty()) judge_drift(campaign, baseline, cell, gates);
  }
  return gates;
}

}  // namespace cablefit
