#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/json/schemas.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/batch_reader.hpp"
#include "cablefit/campaign/cells/cell_fit.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"

namespace cablefit {
namespace {

constexpr double kChanceSds = 3;  // a change this small is chance
constexpr double kWorse = 2;      // times the sd of the baseline

/// Whether a percentage of the parameter's value says anything.
bool is_physical(std::string_view name) {
  const ParameterInfo* info = effect_parameter(name);
  return info != nullptr && std::isfinite(info->lower);
}

Gate gate(std::string name, const BatchCell& cell, double limit, double value,
          std::string_view unit) {
  Gate g{std::move(name), cell.name, limit, value, value <= limit, ""};
  g.text = std::isnan(value) ? fmt::format("FAILED: {}: {} is not known, limit {:.4g} {}",
                                           cell.name, g.name, limit, unit)
                             : fmt::format("{}: {}: {} is {:.4g} {}, limit {:.4g} {}",
                                           g.passed ? "passed" : "FAILED", cell.name, g.name, value,
                                           unit, limit, unit);
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
    gates.push_back(
        gate("torque_error " + equation, cell, limit, error.rms, torque_unit(preload.axes)));
}

/// The cell of the baseline that `cell` is held against: of the same name, else the latest one of
/// the same robot and preload; nullptr when there is none.
const BatchCell* baseline_cell(const std::vector<BatchCell>& cells, const BatchCell& cell) {
  const BatchCell* latest = nullptr;
  for (const BatchCell& other : cells) {
    if (other.name == cell.name) return &other;
    if (other.preload != cell.preload || other.robot != cell.robot) continue;
    if (latest == nullptr || other.date >= latest->date) latest = &other;
  }
  return latest;
}

/// Of parameter `name` in the fit of `model`, what a drift is measured from; NaN when not there.
template <class Result>
Estimate baseline_of(const std::optional<Result>& result, const std::string& model,
                     const std::string& name) {
  if (!result) return {};
  for (const auto& preload : result->preloads)
    for (const auto& fit : preload.fits) {
      if (fit.model != model) continue;
      const Estimate* e = find_estimate(fit.parameters, name);
      if (e != nullptr && std::isfinite(e->value)) return *e;
    }
  return {};
}

/// A change beyond the limit counts only when it is not chance: a coefficient that is known to 50 %
/// may move by 20 %.
Gate drift_gate(const BatchCell& cell, const std::string& name, const Estimate& now,
                const Estimate& before, double limit) {
  const double change = std::abs(now.value - before.value);
  const double drift = change == 0 ? 0 : 100 * change / std::abs(before.value);
  const double sds = change / std::hypot(now.sd, before.sd);
  // One that is known much worse than before hides any change.
  const bool is_known = !(now.sd > kWorse * before.sd);
  const bool is_chance = sds < kChanceSds && is_known;
  Gate g{"drift " + name, cell.name, limit, drift, drift <= limit || is_chance, ""};
  if (std::isnan(now.value)) {
    g.text = fmt::format("FAILED: {}: drift {}: it is not identifiable now", cell.name, name);
  } else if (std::isnan(before.value)) {
    g.text = fmt::format("FAILED: {}: drift {}: the baseline does not have it", cell.name, name);
  } else {
    g.text = fmt::format(
        "{}: {}: drift of {} is {:.3g} % ({:.5g} against {:.5g}), limit {:.4g} %{}",
        g.passed ? "passed" : "FAILED", cell.name, name, drift, now.value, before.value, limit,
        drift > limit && is_chance ? fmt::format("; not significant ({:.1f} sd)", sds) : "");
  }
  return g;
}

/// Offset and encoder zero have no size that a percentage could be of.
bool has_drift(const Estimate& e) { return e.name != "offset" && e.name != "theta_0"; }

void judge_elastic_drift(const BatchCell& cell, const CellResults& before, double limit,
                         std::vector<Gate>& gates) {
  for (const ElasticPreload& preload : cell.elastic->preloads)
    for (const ElasticFit& fit : preload.fits) {
      const bool is_selected = fit.model == preload.selected;
      for (const Estimate& e : fit.parameters) {
        const bool is_stiffness = e.name == "K";
        if (!has_drift(e) || (!is_selected && !is_stiffness)) continue;
        const std::string name = e.name.starts_with("f_") ? e.name + " of stage 1" : e.name;
        gates.push_back(
            drift_gate(cell, name, e, baseline_of(before.elastic, fit.model, e.name), limit));
      }
    }
}

void judge_drift(const Campaign& campaign, const std::vector<BatchCell>& baseline,
                 const BatchCell& cell, std::vector<Gate>& gates) {
  const BatchCell* found = baseline_cell(baseline, cell);
  const CellResults nothing;
  const CellResults& before = found == nullptr ? nothing : *found;
  const double limit = campaign.limits.drift_percent;
  judge_elastic_drift(cell, before, limit, gates);
  if (!cell.dynamic) return;
  for (const DynamicPreload& preload : cell.dynamic->preloads)
    if (const DynamicFit* fit = chosen_fit(*cell.elastic, preload))
      for (const Estimate& e : fit->parameters)
        if (is_physical(e.name))
          gates.push_back(
              drift_gate(cell, e.name, e, baseline_of(before.dynamic, fit->model, e.name), limit));
}

/// Fails when refine named an effect, or could not say.
Gate refine_gate(const BatchCell& cell, const CellRefine& refine) {
  Gate g{"new_effect", cell.name, 0, static_cast<double>(refine.effects.size()), false, ""};
  g.passed = refine.error.empty() && refine.effects.empty();
  if (!refine.error.empty()) {
    g.value = kNotKnown;
    g.text =
        fmt::format("FAILED: {}: new_effect: refine has no verdict: {}", cell.name, refine.error);
  } else if (!refine.effects.empty()) {
    const CellEffect& first = refine.effects.front();
    g.text = fmt::format(
        "FAILED: {}: new_effect: refine identified {} ({} side, p = {:.2g}), verdict "
        "'{}'",
        cell.name, first.name, first.side, first.p_value, refine.verdict);
  } else {
    g.text = fmt::format("passed: {}: new_effect: refine identified none, verdict '{}'", cell.name,
                         refine.verdict);
  }
  return g;
}

/// What could not be fitted has not met its limits.
Gate missing_gate(const BatchCell& cell) {
  return {kFittedGate, cell.name, kNotKnown,
          kNotKnown,   false,     fmt::format("FAILED: {}: could not be fitted", cell.name)};
}

JsonNode read_baseline(const std::string& path) {
  JsonNode root = read_json_file(path);
  const JsonNode& schema = root.at("schema");
  if (schema.text() != kBatchSchema)
    throw schema.error(fmt::format("'schema' is {}, not a batch result", in_quotes(schema.text())),
                       "keep the batch.json of a good run as the baseline");
  return root;
}

}  // namespace

void check_baseline(const Campaign& campaign) {
  const std::string& path = campaign.limits.drift_baseline;
  if (path.empty()) return;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw input_error(
        {campaign.path}, fmt::format("the baseline {} does not exist", path),
        fmt::format("make it with 'cablefit batch {} --accept {}'", campaign.path, path));
  read_baseline(path);
}

std::vector<Gate> judge(const Campaign& campaign, const std::vector<BatchCell>& cells) {
  std::vector<Gate> gates;
  const CampaignLimits& limits = campaign.limits;
  std::vector<BatchCell> baseline;
  if (!limits.drift_baseline.empty())
    baseline = parse_batch_cells(read_baseline(limits.drift_baseline));
  for (const BatchCell& cell : cells) {
    if (!cell.error.empty() || !cell.elastic) {
      gates.push_back(missing_gate(cell));
      continue;
    }
    if (cell.dynamic)
      for (const DynamicPreload& preload : cell.dynamic->preloads) {
        const DynamicFit* fit = chosen_fit(*cell.elastic, preload);
        if (fit == nullptr) continue;
        if (limits.rsd_percent) judge_rsd(cell, *fit, *limits.rsd_percent, gates);
        if (limits.torque_error) judge_error(cell, preload, *fit, *limits.torque_error, gates);
      }
    if (!limits.drift_baseline.empty()) judge_drift(campaign, baseline, cell, gates);
    if (!limits.new_effect && cell.refine) gates.push_back(refine_gate(cell, *cell.refine));
  }
  return gates;
}

}  // namespace cablefit
