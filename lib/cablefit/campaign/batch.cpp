#include "cablefit/campaign/batch.hpp"

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

std::vector<LogSurvey> survey(const std::vector<std::string>& paths, const CampaignCell& cell,
                              int threads) {
  std::vector<LogSurvey> logs;
  for (const std::string& path : paths)
    logs.push_back(survey_log(plan_log(path, rig_for_log(path, cell.rig)), cell.preload, threads));
  return logs;
}

void fit_cell(const Campaign& campaign, const CampaignCell& cell, const BatchOptions& options,
              BatchCell& result) {
  ElasticOptions elastic = options.elastic;
  elastic.samples = options.samples;
  elastic.preload = cell.preload;
  elastic.figures = options.figures;
  result.elastic = fit_elastic(survey(cell.blocked, cell, options.samples.threads), elastic);
  if (cell.moving.empty()) return;
  DynamicOptions dynamic;
  dynamic.samples = options.samples;
  dynamic.models = campaign.models;
  dynamic.estimator = campaign.estimator;
  dynamic.honest_sd = options.honest_sd;
  dynamic.preload = cell.preload;
  dynamic.figures = options.figures;
  result.dynamic =
      fit_dynamic(survey(cell.moving, cell, options.samples.threads), *result.elastic, dynamic);
}

template <class Result>
void append(Result& all, const Result& one) {
  all.inputs.insert(all.inputs.end(), one.inputs.begin(), one.inputs.end());
  all.preloads.insert(all.preloads.end(), one.preloads.begin(), one.preloads.end());
  all.warnings.insert(all.warnings.end(), one.warnings.begin(), one.warnings.end());
}

}  // namespace

ElasticResult BatchResult::all_elastic() const {
  ElasticResult all;
  for (const BatchCell& cell : cells)
    if (cell.elastic) append(all, *cell.elastic);
  return all;
}

DynamicResult BatchResult::all_dynamic() const {
  DynamicResult all;
  for (const BatchCell& cell : cells)
    if (cell.dynamic) append(all, *cell.dynamic);
  return all;
}

BatchResult run_batch(const Campaign& campaign, const BatchOptions& options) {
  check_baseline(campaign);
  BatchResult result;
  result.campaign_path = campaign.path;
  result.campaign_name = campaign.name;
  for (const CampaignCell& cell : campaign.cells) {
    BatchCell fitted;
    fitted.name = cell.preload;
    try {
      fit_cell(campaign, cell, options, fitted);
    } catch (const Error& error) {
      fitted.error = error.what();
      fitted.exit_code = static_cast<int>(error.kind());
    }
    result.cells.push_back(std::move(fitted));
  }
  result.gates = judge(campaign, result.cells);
  return result;
}

}  // namespace cablefit
