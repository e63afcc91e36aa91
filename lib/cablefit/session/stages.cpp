#include "cablefit/session/stages.hpp"

#include <algorithm>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/refine/own_base.hpp"
#include "cablefit/refine/search/model_set.hpp"

namespace cablefit {

std::vector<LogSurvey> logs_of(std::span<const LogSurvey> logs, Phase phase) {
  std::vector<LogSurvey> chosen;
  for (const LogSurvey& log : logs)
    if (std::any_of(log.parts.begin(), log.parts.end(),
                    [phase](const PartSurvey& part) { return part.phase == phase; }))
      chosen.push_back(log);
  return chosen;
}

ElasticResult stiffness(std::span<const LogSurvey> logs, const ElasticOptions& options) {
  return fit_elastic_stage(logs_of(logs, Phase::blocked), options, ElongationMode::automatic);
}

DynamicResult dynamics(std::span<const LogSurvey> logs, const ElasticResult& stage1,
                       const DynamicOptions& options) {
  return fit_dynamic(logs_of(logs, Phase::moving), stage1, options);
}

RefineResult missing_effects(const RefineLogs& logs, const RefineOptions& options) {
  OwnBase base = own_base(logs, options.threads);
  std::vector<LogSurvey> fitted = logs.train;
  fitted.insert(fitted.end(), logs.blocked.begin(), logs.blocked.end());
  const std::vector<Model> models = models_with_logs(std::move(base.models), fitted);
  require_model_set(models);
  RefineResult result = refine(models, logs, options);
  result.model_choice = "fitted to the logs";
  result.decisions.insert(result.decisions.begin(), base.decisions.begin(), base.decisions.end());
  return result;
}

}  // namespace cablefit
