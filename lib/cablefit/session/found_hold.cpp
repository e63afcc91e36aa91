#include "cablefit/session/found_hold.hpp"

#include <fmt/format.h>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/rows/motion.hpp"
#include "cablefit/refine/steps/torque_lateness.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/torque_hold.hpp"

namespace cablefit {
namespace {

/// s, of the moving training logs; nothing where they differ.
std::optional<double> moving_row(const RefineLogs& logs) {
  constexpr double kSame = 1.01;
  const RateRange rates =
      sample_rates(logs.train, [](const PartSurvey& part) { return part.phase == Phase::moving; });
  if (!(rates.highest > 0) || rates.highest > kSame * rates.lowest) return std::nullopt;
  return 1 / rates.highest;
}

std::optional<Decision> take_hold(const TorqueLateness& late, double row, RefineLogs& logs,
                                  std::vector<Model>& models) {
  const std::optional<int> periods = drive_periods(late, row);
  if (!periods) return std::nullopt;
  const FoundHold hold = hold_of(*periods, row);
  for (Model& model : models) set_torque_hold(hold, model.rig);
  for (auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (LogSurvey& log : *some) set_torque_hold(hold, log.plan.rig);
  return Decision{"torque hold", name_of(hold),
                  fmt::format("the torque acts {:.2g} +- {:.1g} ms after its time stamp; the rig "
                              "file has no \"torque_hold\"",
                              1e3 * late.seconds, 1e3 * late.sd)};
}

/// Of the joint that shows it best: all drives are taken to be of one kind.
std::optional<TorqueLateness> lateness_of(const RefineLogs& logs, const std::vector<Model>& models,
                                          double row) {
  const std::vector<LogSurvey> fitted = logs.fitted();
  const int n = static_cast<int>(models.front().joints.size());
  if (n == 1) return fit_torque_lateness(models, fitted, row);
  std::optional<TorqueLateness> best;
  for (int joint = 0; joint < n; ++joint) {
    std::vector<Model> alone;
    for (const Model& model : models) alone.push_back(one_joint(model, joint));
    const auto late = fit_torque_lateness(alone, fitted, row);
    if (late && (!best || late->sd < best->sd)) best = late;
  }
  return best;
}

const Estimate* found_delay(const RefineResult& result) {
  for (const NamedEffect& effect : result.effects)
    if (effect.instance.effect->delays_torque) return &effect.instance.parameters.front();
  return nullptr;
}

}  // namespace

bool is_hold_open(const RefineLogs& logs, const std::vector<Model>& models) {
  const auto is_automatic = [](const Rig& rig) {
    return rig.torque_hold == TorqueHold::automatic && !(rig.torque_period > 0);
  };
  for (const Model& model : models)
    if (!is_automatic(model.rig)) return false;
  for (const auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (const LogSurvey& log : *some)
      if (!is_automatic(log.plan.rig)) return false;
  return true;
}

std::optional<Decision> take_fitted_hold(RefineLogs& logs, std::vector<Model>& models) {
  const std::optional<double> row = moving_row(logs);
  if (!row) return std::nullopt;
  const auto late = lateness_of(logs, models, *row);
  return late ? take_hold(*late, *row, logs, models) : std::nullopt;
}

std::optional<Decision> take_found_hold(const RefineResult& result, RefineLogs& logs,
                                        std::vector<Model>& models) {
  const Estimate* delay = found_delay(result);
  const std::optional<double> row = moving_row(logs);
  if (delay == nullptr || !row) return std::nullopt;
  const double now = torque_lateness(models.front().rig, *row);
  const TorqueLateness late{now * *row + delay->value, delay->sd};
  const std::optional<int> periods = drive_periods(late, *row);
  if (!periods || lateness_of(*periods, 1) == now) return std::nullopt;
  return take_hold(late, *row, logs, models);
}

}  // namespace cablefit
