#include "cablefit/session/found_hold.hpp"

#include <fmt/format.h>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/rows/motion.hpp"
#include "cablefit/refine/steps/torque_lateness.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/torque_hold.hpp"

namespace cablefit {
namespace {

/// s, of logs of this phase; nothing where they differ.
std::optional<double> row_of(std::span<const LogSurvey> logs, Phase phase) {
  const RateRange rates =
      sample_rates(logs, [phase](const PartSurvey& part) { return part.phase == phase; });
  if (!(rates.highest > 0) || rates.highest > kSameRate * rates.lowest) return std::nullopt;
  return 1 / rates.highest;
}

/// s, of blocked logs where they are slower than the moving ones.
std::optional<double> slow_blocked_row(const RefineLogs& logs, double moving) {
  const std::optional<double> row = row_of(logs.fitted(), Phase::blocked);
  return row && *row > kSameRate * moving ? row : std::nullopt;
}

void set_hold(const FoundHold& hold, RefineLogs& logs, std::vector<Model>& models) {
  for (Model& model : models) set_torque_hold(hold, model.rig);
  for (auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (LogSurvey& log : *some) set_torque_hold(hold, log.plan.rig);
}

std::string acts(const TorqueLateness& late) {
  return fmt::format("the torque acts {:.2g} +- {:.1g} ms after its time stamp", 1e3 * late.seconds,
                     1e3 * late.sd);
}

std::optional<Decision> take_hold(const TorqueLateness& late, double row, RefineLogs& logs,
                                  std::vector<Model>& models) {
  const std::optional<int> periods = drive_periods(late, row);
  if (!periods) return std::nullopt;
  const FoundHold hold = hold_of(*periods, row);
  set_hold(hold, logs, models);
  return Decision{"torque hold", name_of(hold),
                  acts(late) + "; the rig file has no \"torque_hold\""};
}

/// The lateness of the joint with the least sd: all drives are assumed to be of one kind.
template <typename Late, typename Fit>
std::optional<Late> best_of_joints(const std::vector<Model>& models, Fit fit,
                                   double (*sd)(const Late&)) {
  const int n = static_cast<int>(models.front().joints.size());
  std::optional<Late> best;
  for (int joint = 0; joint < n; ++joint) {
    const std::optional<Late> late = fit(n == 1 ? models : one_joint(models, joint));
    if (late && (!best || sd(*late) < sd(*best))) best = late;
  }
  return best;
}

/// Of the blocked torque against the moving one.
TorqueLateness later(const SplitLateness& late) {
  return {late.blocked.seconds - late.moving.seconds, std::hypot(late.blocked.sd, late.moving.sd)};
}

/// Sample periods, s.
struct HoldRows {
  double moving = 0;
  double slow_blocked = 0;  ///< 0: blocked logs are not slower, or differ
};

struct Lateness {
  std::optional<TorqueLateness> moving;
  std::optional<SplitLateness> split;  ///< where blocked logs are slower
};

Lateness lateness_of(const RefineLogs& logs, const std::vector<Model>& models,
                     const HoldRows& rows) {
  const std::vector<LogSurvey> fitted = logs.fitted();
  Lateness late;
  if (rows.slow_blocked > 0)
    late.split = best_of_joints<SplitLateness>(
        models,
        [&](const std::vector<Model>& one) {
          return fit_split_lateness(one, fitted, rows.moving, rows.slow_blocked);
        },
        [](const SplitLateness& split) { return later(split).sd; });
  if (late.split)
    late.moving = late.split->moving;
  else
    late.moving = best_of_joints<TorqueLateness>(
        models,
        [&](const std::vector<Model>& one) {
          return fit_torque_lateness(one, fitted, rows.moving);
        },
        [](const TorqueLateness& one) { return one.sd; });
  return late;
}

/// The period of the drive for slow blocked logs too.
std::optional<Decision> take_period(const SplitLateness& split, const HoldRows& rows,
                                    RefineLogs& logs, std::vector<Model>& models) {
  if (models.front().rig.torque_hold == TorqueHold::none) return std::nullopt;  // just found
  if (!is_same_drive(later(split), rows.slow_blocked, rows.moving).value_or(false))
    return std::nullopt;
  const double found = models.front().rig.torque_period;
  const FoundHold hold{true, found > 0 ? found : rows.moving};
  set_hold(hold, logs, models);
  return Decision{
      "blocked: torque hold", name_of(hold),
      fmt::format("{}, in the moving logs {:.2g} ms; the rig file has no \"torque_period\"",
                  acts(split.blocked), 1e3 * split.moving.seconds)};
}

bool all_rigs(const RefineLogs& logs, const std::vector<Model>& models, bool (*is)(const Rig&)) {
  for (const Model& model : models)
    if (!is(model.rig)) return false;
  for (const auto* some : {&logs.train, &logs.test, &logs.blocked})
    for (const LogSurvey& log : *some)
      if (!is(log.plan.rig)) return false;
  return true;
}

/// Whether no rig file says over what period a torque is held.
bool is_period_open(const RefineLogs& logs, const std::vector<Model>& models) {
  return all_rigs(logs, models, [](const Rig& rig) {
    return rig.torque_hold != TorqueHold::none && !(rig.torque_period > 0);
  });
}

const Estimate* found_delay(const RefineResult& result) {
  for (const NamedEffect& effect : result.effects)
    if (effect.instance.effect->delays_torque) return &effect.instance.parameters.front();
  return nullptr;
}

}  // namespace

bool is_hold_open(const RefineLogs& logs, const std::vector<Model>& models) {
  return all_rigs(logs, models, [](const Rig& rig) {
    return rig.torque_hold == TorqueHold::automatic && !(rig.torque_period > 0);
  });
}

std::vector<Decision> take_fitted_hold(RefineLogs& logs, std::vector<Model>& models) {
  const bool hold_is_open = is_hold_open(logs, models);
  const bool period_is_open = is_period_open(logs, models);
  const std::optional<double> moving = row_of(logs.train, Phase::moving);
  if (!moving) return {};
  const HoldRows rows{*moving, period_is_open ? slow_blocked_row(logs, *moving).value_or(0) : 0};
  if (!hold_is_open && rows.slow_blocked == 0) return {};
  const Lateness late = lateness_of(logs, models, rows);
  std::vector<Decision> decisions;
  const auto add = [&](std::optional<Decision> decision) {
    if (decision) decisions.push_back(*std::move(decision));
  };
  if (hold_is_open && late.moving) add(take_hold(*late.moving, *moving, logs, models));
  if (late.split) add(take_period(*late.split, rows, logs, models));
  return decisions;
}

std::optional<Decision> take_found_hold(const RefineResult& result, RefineLogs& logs,
                                        std::vector<Model>& models) {
  const Estimate* delay = found_delay(result);
  const std::optional<double> row = row_of(logs.train, Phase::moving);
  if (delay == nullptr || !row) return std::nullopt;
  const double now = torque_lateness(models.front().rig, *row);
  const TorqueLateness late{now * *row + delay->value, delay->sd};
  const std::optional<int> periods = drive_periods(late, *row);
  if (!periods || lateness_of(*periods, 1) == now) return std::nullopt;
  return take_hold(late, *row, logs, models);
}

}  // namespace cablefit
