#include "cablefit/session/stages.hpp"

#include <algorithm>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/refine/bases/own_base.hpp"
#include "cablefit/refine/bases/simpler_bases.hpp"
#include "cablefit/refine/held_cables.hpp"
#include "cablefit/refine/search/model_set.hpp"
#include "cablefit/samples/survey/phases.hpp"
#include "cablefit/session/found_controller.hpp"
#include "cablefit/session/found_hold.hpp"
#include "cablefit/session/replayed_torque.hpp"

namespace cablefit {

std::vector<LogSurvey> logs_of(std::span<const LogSurvey> logs, Phase phase) {
  std::vector<LogSurvey> chosen;
  for (const LogSurvey& log : logs)
    if (has_phase(log, phase)) chosen.push_back(log);
  return chosen;
}

namespace {

/// Without one of this phase all of them: the stage says what it misses.
std::vector<LogSurvey> logs_for(std::span<const LogSurvey> logs, Phase phase) {
  std::vector<LogSurvey> chosen = logs_of(logs, phase);
  return chosen.empty() ? std::vector<LogSurvey>(logs.begin(), logs.end()) : chosen;
}

}  // namespace

ElasticResult stiffness(std::span<const LogSurvey> logs, const ElasticOptions& options) {
  return fit_elastic_stage(logs_for(logs, Phase::blocked), options, ElongationMode::automatic);
}

DynamicResult dynamics(std::span<const LogSurvey> logs, const ElasticResult& stage1,
                       const DynamicOptions& options) {
  return fit_dynamic(logs_for(logs, Phase::moving), stage1, options);
}

namespace {

/// The models of preloads that there are logs of, and what was chosen for them.
OwnBase complete(std::vector<Model> models, const RefineLogs& logs, const RefineOptions& options) {
  OwnBase base;
  if (models.empty()) {
    base = own_base(logs, options.threads);
    std::erase_if(base.models, [&](const Model& model) {
      return !options.preload.empty() && model.preload != options.preload;
    });
  } else {
    base.elongations = elongation_covariance(models);
    base.decisions = fill_start_values(models);
    base.models = std::move(models);
  }
  base.models = models_with_logs(std::move(base.models), logs.fitted());
  require_model_set(base.models);
  return base;
}

}  // namespace

namespace {

RefineResult refine_from(const OwnBase& base, const RefineLogs& logs, RefineOptions options) {
  options.elongations = base.elongations;
  return refine(base.models, logs, options);
}

/// From a simpler base, which is the base from now on; nothing where the logs do not determine it.
std::optional<RefineResult> refine_simpler(SimplerBase simpler, const RefineLogs& logs,
                                           const RefineOptions& options, OwnBase& base) {
  try {
    RefineResult result = refine_from(simpler.base, logs, options);
    base = std::move(simpler.base);
    result.warnings.push_back(std::move(simpler.warning));
    return result;
  } catch (const Error& error) {
    // Too few rows may be left to judge by; another base keeps them.
    if (error.kind() != ErrorKind::not_identifiable && error.kind() != ErrorKind::input) throw;
    return {};
  }
}

/// Where the logs hardly load a cable, or their training part does not determine the base, from the
/// first simpler one that it determines.
RefineResult refine_own(OwnBase& base, const RefineLogs& logs, const RefineOptions& options) {
  if (auto simpler = base_without_idle_cable(base, logs))
    if (auto result = refine_simpler(*std::move(simpler), logs, options, base)) return *result;
  std::string why;
  try {
    return refine_from(base, logs, options);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
    why = error.what();
  }
  for (SimplerBase& simpler : simpler_bases(base, logs, why))
    if (auto result = refine_simpler(std::move(simpler), logs, options, base)) return *result;
  throw Error(ErrorKind::not_identifiable, why);
}

/// Whether an l_o was searched (by the rig file, or for a preload without cables in a rig file) and
/// its error is not known.
bool has_unsure_elongation(const Model& model, const ElongationCovariance& known) {
  const std::vector<Cable>& cables = model.transmission.cables;
  const std::vector<bool>& asked = model.rig.search_elongation;
  for (std::size_t c = 0; c < cables.size(); ++c) {
    const bool was_searched = cables[c].initial_elongation != 0 &&
                              (!model.rig.cables_given || (c < asked.size() && asked[c]));
    const bool is_known =
        std::any_of(known.of.begin(), known.of.end(), [&](const ElongationCovariance::Of& of) {
          return of.preload == model.preload && of.name == elongation_name(cables[c]);
        });
    if (was_searched && !is_known) return true;
  }
  return false;
}

}  // namespace

RefineResult missing_effects(const RefineLogs& logs, std::vector<Model> models,
                             const RefineOptions& options) {
  const bool is_own = models.empty();
  OwnBase base = complete(std::move(models), logs, options);
  RefineLogs own_logs = logs;
  if (auto controller = take_found_controller(own_logs, base.models))
    base.decisions.push_back(*std::move(controller));
  if (auto replay = replayed_torque(own_logs)) base.decisions.push_back(*std::move(replay));
  hold_undetermined_cables(base.models, own_logs);
  const bool hold_is_open = is_hold_open(own_logs, base.models);
  std::vector<Decision> holds = take_fitted_hold(own_logs, base.models);
  const auto refined = [&] {
    return is_own ? refine_own(base, own_logs, options) : refine_from(base, own_logs, options);
  };
  RefineResult result = refined();
  if (auto other = hold_is_open ? take_found_hold(result, own_logs, base.models) : std::nullopt) {
    holds = take_fitted_hold(own_logs, base.models);
    holds.insert(holds.begin(), *std::move(other));
    result = refined();
  }
  base.decisions.insert(base.decisions.end(), holds.begin(), holds.end());
  if (is_own) result.model_choice = "fitted to the logs";
  const bool is_unsure = std::any_of(
      base.models.begin(), base.models.end(),
      [&](const Model& model) { return has_unsure_elongation(model, base.elongations); });
  if (is_unsure) result.warnings.emplace_back(kElongationsHeld);
  result.decisions.insert(result.decisions.begin(), base.decisions.begin(), base.decisions.end());
  return result;
}

RefineResult missing_effects(const RefineLogs& logs, const RefineOptions& options) {
  return missing_effects(logs, {}, options);
}

}  // namespace cablefit
