#include "cablefit/session/replayed_torque.hpp"

#include <string>

#include "cablefit/samples/survey/phases.hpp"
#include "cablefit/simulate/experiment.hpp"

namespace cablefit {

std::optional<Decision> replayed_torque(const RefineLogs& logs) {
  for (const LogSurvey& log : logs.test.empty() ? logs.train : logs.test) {
    const std::string obstacle = has_phase(log, Phase::moving) ? no_closed_loop(log.plan) : "";
    if (!obstacle.empty())
      return Decision{std::string(kReplayedTorque), "simulations of test logs", obstacle};
  }
  return std::nullopt;
}

}  // namespace cablefit
