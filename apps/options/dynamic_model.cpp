#include "options/dynamic_model.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/elastic/curve_of_model.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/session/read_logs.hpp"
#include "cablefit/simulate/experiment.hpp"
#include "options/stage1_logs.hpp"
#include "output/progress.hpp"

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
    throw usage_error("a model is given, but no log to fit it to",
                      "give one or more logs after the model");
  return start;
}

std::vector<LogSurvey> read_logs_of(const StartModel& start, const CommonOptions& options) {
  const Progress progress(options.quiet, "reading logs");
  return cablefit::read_logs(options.logs, [&](const std::string& path) {
    return survey_for_simulation(path, options.rig, start.model, options.reading);
  });
}

void use_model(const StartModel& start, DynamicOptions& fit) {
  fit.models = {std::string(default_model_name(start.model))};
  fit.effects = added_effects(start.model);
}

void use_model(const StartModel& start, IdentifyOptions& fit) {
  if (start.model.rigid)
    throw usage_error("one step needs cables; the model is a rigid drive",
                      "use 'cablefit dynamic' with it");
  fit.effects = added_effects(start.model);
  if (fit.order > 0 || start.model.rig.cables_given) return;
  for (const Cable& cable : start.model.transmission.cables)
    fit.order = std::max(fit.order, cable.order);
}

std::string missing_sd(const Model& model) {
  std::string names;
  const ElasticResult curve = curve_of(model);
  for (const Estimate& e : curve.preloads.front().fits.front().parameters)
    if (!std::isfinite(e.sd)) names += (names.empty() ? "" : ", ") + e.name;
  return names;
}

ElasticResult stage1_of(const StartModel& start) {
  return start.model.rigid ? ElasticResult{} : curve_of(start.model);
}

}  // namespace cablefit::apps
