#include "cablefit/campaign/cells/cell_fit.hpp"

#include <algorithm>

#include "cablefit/base/error.hpp"
#include "cablefit/model/effects/effect_names.hpp"
#include "cablefit/prove/model_to_simulate.hpp"
#include "cablefit/session/read_logs.hpp"
#include "cablefit/session/stages.hpp"

namespace cablefit {
namespace {

std::vector<LogSurvey> survey(const std::vector<std::string>& paths, const CampaignCell& cell,
                              const BatchOptions& options) {
  if (paths.empty()) return {};
  return read_logs(paths, [&](const std::string& path) {
    return survey_log(plan_log(path, rig_for_log(path, cell.rig), options.reading), cell.preload,
                      options.samples.threads);
  });
}

/// A result is kept under the content that the logs had when the cell was begun.
void require_unchanged(const std::vector<LogSurvey>& logs, const CellKey& key) {
  for (const LogSurvey& log : logs)
    if (key.sha256.at(log.plan.path) != log.sha256)
      throw input_error({log.plan.path, 0, 0}, "changed while it was read",
                        "run again when no program writes to it");
}

ElasticOptions stage1_options(const CampaignCell& cell, const BatchOptions& options, bool figures) {
  ElasticOptions elastic = options.elastic;
  elastic.samples = options.samples;
  elastic.robust_sd = options.robust_sd;
  elastic.preload = cell.preload;
  elastic.figures = figures;
  return elastic;
}

DynamicOptions stage2_options(const Campaign& campaign, const CampaignCell& cell,
                              const BatchOptions& options) {
  DynamicOptions dynamic;
  dynamic.samples = options.samples;
  dynamic.models = campaign.models;
  dynamic.estimator = campaign.estimator;
  dynamic.robust_sd = options.robust_sd;
  dynamic.preload = cell.preload;
  dynamic.figures = with_figures(campaign);
  return dynamic;
}

CellEffect effect_of(const NamedEffect& named) {
  CellEffect effect;
  effect.name = named.instance.effect->name;
  effect.side = to_string(named.instance.effect->site);
  effect.gain = named.evidence.gain;
  effect.p_value = named.evidence.p_value;
  effect.torque_rms = named.torque_rms;
  for (const Rival& rival : named.rivals) effect.rivals.push_back(rival.name);
  return effect;
}

CellRefine verdict_of(const RefineResult& result) {
  CellRefine refine;
  refine.verdict = to_string(result.verdict);
  refine.reason = result.reason;
  for (const NamedEffect& named : result.effects) refine.effects.push_back(effect_of(named));
  refine.torque = result.torque;
  refine.simulation = result.simulation;
  refine.next_experiment = result.next_experiment;
  return refine;
}

/// The model of stage 2 as refine starts from it; none where that cannot move.
std::vector<Model> base_models(const ElasticResult& elastic, const DynamicResult& dynamic,
                               const Rig& rig) {
  const DynamicPreload& preload = dynamic.preloads.front();
  const DynamicFit* fit = chosen_fit(elastic, preload);
  if (fit == nullptr) return {};
  std::string why_not;
  Model model = model_to_simulate(*fit, preload, rig, why_not);
  if (!why_not.empty()) return {};
  if (fit->elastic) model.elastic = fit->elastic->parameters;
  return {model};
}

CellRefine refine_cell(const CampaignCell& cell, const CellResults& fitted, const RefineLogs& logs,
                       const BatchOptions& options) {
  RefineOptions refine_options;
  refine_options.seed = options.seed;
  refine_options.n_draws = cell.refine->n_draws;
  refine_options.threads = options.samples.threads;
  try {
    const Rig rig = rig_for_log(cell.moving.front(), cell.rig);
    return verdict_of(
        missing_effects(logs, base_models(*fitted.elastic, *fitted.dynamic, rig), refine_options));
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::output) throw;  // a full disk says nothing about the robot
    CellRefine none;
    none.error = error.what();
    std::replace(none.error.begin(), none.error.end(), '\n', ' ');
    return none;
  }
}

/// A log with blocked and moving parts is given once to refine, which takes each for what it is.
bool holds(const std::vector<LogSurvey>& logs, const LogSurvey& log) {
  return std::any_of(logs.begin(), logs.end(),
                     [&](const LogSurvey& other) { return other.plan.path == log.plan.path; });
}

}  // namespace

const DynamicFit* chosen_fit(const ElasticResult& elastic, const DynamicPreload& preload) {
  if (preload.fits.empty()) return nullptr;
  for (const ElasticPreload& stage1 : elastic.preloads)
    if (stage1.name == preload.name)
      for (const DynamicFit& fit : preload.fits)
        if (fit.model == stage1.selected) return &fit;
  return &preload.fits.back();
}

CellResults fit_cell(const Campaign& campaign, const CampaignCell& cell, const CellKey& key,
                     const BatchOptions& options) {
  const auto read = [&](const std::vector<std::string>& paths) {
    std::vector<LogSurvey> logs = survey(paths, cell, options);
    require_unchanged(logs, key);
    return logs;
  };
  CellResults results;
  RefineLogs logs;
  logs.blocked = read(cell.blocked);
  results.elastic = stiffness(logs.blocked, stage1_options(cell, options, with_figures(campaign)));
  if (cell.moving.empty()) return results;
  const std::vector<LogSurvey> moving = read(cell.moving);
  DynamicOptions dynamic = stage2_options(campaign, cell, options);
  dynamic.effects = blank_effects(campaign.effects, moving.front().plan.rig.n_joints());
  dynamic.validation = read(cell.validation);
  results.dynamic = dynamics(moving, *results.elastic, dynamic);
  if (!cell.refine) return results;
  logs.train = cell.refine->train.empty() ? moving : read(cell.refine->train);
  logs.test = read(cell.refine->test);
  std::erase_if(logs.blocked, [&](const LogSurvey& log) { return holds(logs.train, log); });
  results.refine = refine_cell(cell, results, logs, options);
  return results;
}

}  // namespace cablefit
