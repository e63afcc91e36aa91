#include "cablefit/samples/agreement.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/base/digest.hpp"

namespace cablefit {
namespace {

constexpr double kRateTolerance = 0.01;

std::string content(const Rig& rig) { return rig.path.empty() ? "" : sha256_of_file(rig.path); }

void require_same_rig(const LogSurvey& first, const LogSurvey& log, const std::string& preload) {
  const Rig& a = first.plan.rig;
  const Rig& b = log.plan.rig;
  if (a.path == b.path || content(a) == content(b)) return;
  const auto name = [](const Rig& rig) { return rig.path.empty() ? "no rig file" : rig.path; };
  throw input_error(
      {log.plan.path, 0, 0},
      fmt::format("preload '{:.40}' has logs of two rigs, {} and {}", preload, name(a), name(b)),
      "fit them apart, or name their preloads differently in the rig files");
}

void require_same_rate(const LogSurvey& log, const PartSurvey& part, double rate) {
  if (std::abs(1 / part.period - rate) <= kRateTolerance * rate) return;
  throw input_error({log.plan.path, 0, 0},
                    fmt::format("its rate of {:.4g} Hz differs from {:.4g} Hz of the logs before",
                                1 / part.period, rate),
                    "logs of different rates need different filters: fit them apart");
}

}  // namespace

double sample_rate(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (wanted(part)) return 1 / part.period;
  return 0;
}

void require_agreement(std::span<const LogSurvey> logs, const PartFilter& wanted,
                       const std::string& preload) {
  const double rate = sample_rate(logs, wanted);
  const LogSurvey* first = nullptr;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      if (!wanted(part)) continue;
      if (first == nullptr) first = &log;
      require_same_rate(log, part, rate);
      require_same_rig(*first, log, preload);
      const Load& load = log.plan.rig.load;
      if (part.phase == Phase::moving && load.law != nullptr && load.law->from_column)
        require_channel(log.plan, Channel::tau_load, "the load that the rig file says is a column");
    }
}

}  // namespace cablefit
