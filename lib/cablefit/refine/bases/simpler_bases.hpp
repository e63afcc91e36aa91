// Bases for refine where the training samples do not determine its own base.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/refine/bases/own_base.hpp"

namespace cablefit {

struct SimplerBase {
  OwnBase base;
  std::string warning;  ///< possible consequences
};

/// For a plain pair of cables (none in the rig file): the base without a cable that is taut so
/// rarely that the logs hardly determine its law. Otherwise few samples would decide on its
/// coefficients, and these would change all others.
std::optional<SimplerBase> base_without_idle_cable(const OwnBase& base, const RefineLogs& logs);

/// Bases with fewer parameters, in the order in which to try them. First, with a plain pair of
/// cables, the less loaded one with one coefficient, then without that cable. Then one straight
/// spring. None without cables, and none with several joints: a spring per joint does not describe
/// cables that pass several joints. `why` is the reason in the decisions.
std::vector<SimplerBase> simpler_bases(const OwnBase& base, const RefineLogs& logs,
                                       const std::string& why);

}  // namespace cablefit
