#include "commands/dynamic_model.hpp"

#include "cablefit/base/error.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/elastic/curve_of_model.hpp"
#include "cablefit/model/read_models.hpp"
#include "cablefit/samples/weigh/weigh.hpp"
#include "cablefit/simulate/experiment.hpp"
#include "commands/progress.hpp"
#include "commands/stage1_logs.hpp"

namespace cablefit::apps {

std::optional<StartModel> take_model(CommonOptions& options, const std::string& fit_name) {
  if (options.logs.empty() || !is_model(options.logs.front())) return std::nullopt;
  StartModel start;
  start.path = options.logs.front();
  options.logs.erase(options.logs.begin());
  options.more_inputs.push_back(start.path);
  std::vector<Model> models =
      read_models(start.path, options.preload, fit_name, start.choice, Completeness::as_it_is);
  if (models.size() > 1)
    throw input_error({start.path}, "the result has several preloads",
                      "choose one with --preload NAME");
  start.model = std::move(models.front());
  if (options.logs.empty())
    throw usage_error("a model, and no log to fit it to", "name one or more logs behind it");
  return start;
}

std::vector<LogSurvey> read_logs_of(const StartModel& start, const CommonOptions& options) {
  const Progress progress(options.quiet, "reading logs");
  std::vector<LogSurvey> logs;
  Problems problems;
  for (const std::string& path : options.logs)
    problems.collect([&] {
      logs.push_back(survey_for_simulation(path, options.rig, start.model, options.reading));
    });
  problems.throw_if_any();
  weigh_logs(logs);
  return logs;
}

void use_model(const StartModel& start, DynamicOptions& fit) {
  fit.models = {std::string(default_model_name(start.model))};
  for (const JointModel& joint : start.model.joints)
    fit.effects.insert(fit.effects.end(), joint.refinements.begin(), joint.refinements.end());
}

ElasticResult stage1_of(const StartModel& start) {
  return start.model.rigid ? ElasticResult{} : curve_of(start.model);
}

}  // namespace cablefit::apps
