#include "cablefit/session/found_controller.hpp"

#include <algorithm>

#include "cablefit/dynamic/loops/controller_fit.hpp"
#include "cablefit/samples/survey/phases.hpp"

namespace cablefit {
namespace {

bool is_moving(const PartSurvey& part) { return part.phase == Phase::moving; }

bool says_how_it_is_driven(const Rig& rig) { return rig.controller || rig.open_loop; }

/// Whether the controller was found from it.
bool is_source(const LogSurvey& log, bool trains) {
  return trains && has_phase(log, Phase::moving);
}

/// A blocked sweep or a test log may have been driven with other gains.
bool has_other_gains(LogSurvey log, const Controller& controller) {
  log.plan.rig.controller = controller;
  const auto fit = check_controllers({&log, 1}, [](const PartSurvey&) { return true; });
  return fit && !fit->all_fit();
}

}  // namespace

std::optional<Decision> take_found_controller(RefineLogs& logs, std::vector<Model>& models) {
  std::vector<LogSurvey> moving;
  std::copy_if(logs.train.begin(), logs.train.end(), std::back_inserter(moving),
               [](const LogSurvey& log) { return has_phase(log, Phase::moving); });
  if (moving.empty()) return std::nullopt;
  for (const auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (const LogSurvey& log : *some)
      if (says_how_it_is_driven(log.plan.rig)) return std::nullopt;
  for (const Model& model : models)
    if (says_how_it_is_driven(model.rig)) return std::nullopt;

  const std::optional<ControllerFits> found = fit_controllers(moving, is_moving);
  if (!found || !found->all_fit()) return std::nullopt;
  const Controller controller = found->controller();
  for (auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (LogSurvey& log : *some)
      if (is_source(log, some == &logs.train) || !has_other_gains(log, controller))
        log.plan.rig.controller = controller;
  for (Model& model : models) model.rig.controller = controller;
  return Decision{"controller", found->text(models.front().rig.axes),
                  "found from reference, position and torque of the training logs, as the rig file "
                  "names none"};
}

}  // namespace cablefit
