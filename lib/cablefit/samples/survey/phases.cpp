#include "cablefit/samples/survey/phases.hpp"

#include <algorithm>

namespace cablefit {

bool has_phase(const LogSurvey& log, Phase phase) {
  return std::any_of(log.parts.begin(), log.parts.end(),
                     [phase](const PartSurvey& part) { return part.phase == phase; });
}

}  // namespace cablefit
