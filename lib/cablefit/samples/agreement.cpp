#include "cablefit/samples/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/digest.hpp"

namespace cablefit {
namespace {

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

}  // namespace

RateRange sample_rates(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  RateRange rates{kUnbounded, 0};
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      if (!wanted(part)) continue;
      rates.lowest = std::min(rates.lowest, 1 / part.period);
      rates.highest = std::max(rates.highest, 1 / part.period);
    }
  return rates;
}

void require_agreement(std::span<const LogSurvey> logs, const PartFilter& wanted,
                       const std::string& preload) {
  const LogSurvey* first = nullptr;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      if (!wanted(part)) continue;
      if (first == nullptr) first = &log;
      require_same_rig(*first, log, preload);
      const Load& load = log.plan.rig.load;
      if (part.phase == Phase::moving && load.law != nullptr && load.law->from_column)
        require_channel(log.plan, Channel::tau_load, "the load that the rig file says is a column");
    }
}

}  // namespace cablefit
