#include "cablefit/refine/verdict/confirm.hpp"

#include <cmath>
#include <map>

#include "cablefit/base/error.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/simulate/replay.hpp"

namespace cablefit {
namespace {

struct Sum {
  double squares = 0, n = 0;
  void add(double rms, double rows) {
    squares += rows * rms * rms;
    n += rows;
  }
  double rms() const { return n > 0 ? std::sqrt(squares / n) : 0; }
};

std::vector<LogSurvey> logs_of(const Model& model, std::span<const LogSurvey> logs, bool all) {
  std::vector<LogSurvey> out;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (part.phase == Phase::moving && (all || part.preload == model.preload)) {
        out.push_back(log);
        break;
      }
  return out;
}

}  // namespace

SimulatedGap simulated_gap(std::span<const Model> models, std::span<const LogSurvey> logs,
                           int threads, double compared) {
  SimulatedGap gap;
  Sum deflection, tau;
  for (const Model& model : models) {
    const std::vector<LogSurvey> own = logs_of(model, logs, models.size() == 1);
    const std::string joint =
        model.whole == nullptr ? "" : std::to_string(model.joint + 1);  // "deflection2"
    if (own.empty()) continue;
    ReplayOptions options;
    options.threads = threads;
    options.compared = compared;
    try {
      for (const SimulatedPart& part : simulate_logs(whole_of(model), own, options).parts) {
        if (!part.diverged.empty()) gap.failure = part.diverged;
        if (part.phase != to_string(Phase::moving)) continue;
        const auto rows = static_cast<double>(part.n_rows);
        for (const SignalGap& signal : part.gaps) {
          if (signal.signal == (model.rigid ? "theta" : "deflection") + joint)
            deflection.add(signal.rms, rows);
          if (signal.signal == "tau" + joint) tau.add(signal.rms, rows);
        }
      }
    } catch (const Error& error) {
      gap.failure = error.what();
    }
  }
  if (gap.known() && deflection.n == 0) gap.failure = "no log has a moving part";
  gap.deflection = deflection.rms();
  gap.tau = tau.rms();
  return gap;
}

double in_floors(const SimulatedGap& gap, const SimulatedGap& floor) {
  const auto ratio = [](double value, double of) { return of > 0 ? value * value / (of * of) : 0; };
  return ratio(gap.deflection, floor.deflection) + ratio(gap.tau, floor.tau);
}

}  // namespace cablefit
