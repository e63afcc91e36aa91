#include "cablefit/session/replayed_torque.hpp"

#include <algorithm>
#include <string>

#include "cablefit/simulate/experiment.hpp"

namespace cablefit {
namespace {

bool moves(const LogSurvey& log) {
  return std::any_of(log.parts.begin(), log.parts.end(),
                     [](const PartSurvey& part) { return part.phase == Phase::moving; });
}

}  // namespace

std::optional<Decision> replayed_torque(const RefineLogs& logs) {
  for (const LogSurvey& log : logs.test.empty() ? logs.train : logs.test) {
    const std::string obstacle = moves(log) ? no_closed_loop(log.plan) : "";
    if (!obstacle.empty())
      return Decision{std::string(kReplayedTorque), "simulations of test logs", obstacle};
  }
  return std::nullopt;
}

}  // namespace cablefit
