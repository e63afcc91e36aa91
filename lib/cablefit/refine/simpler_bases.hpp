// What refine begins with where the training samples do not determine its own base.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/refine/own_base.hpp"

namespace cablefit {

struct SimplerBase {
  OwnBase base;
  std::string warning;  ///< what may come of it
};

/// Of a plain pair of cables (none in the rig file) one of which is taut so rarely that the logs
/// hardly determine its law: the base without it. Few samples would otherwise decide over its
/// coefficients, and these over the rest.
std::optional<SimplerBase> base_without_idle_cable(const OwnBase& base, const RefineLogs& logs);

/// Bases with less to determine, in the order in which to try them. First, of a plain pair of
/// cables, the less loaded one with one coefficient, then without it; then
/// one straight spring. None without cables, and none of several joints: a spring per joint is not
/// what cables do that pass several. The decisions say `why`.
std::vector<SimplerBase> simpler_bases(const OwnBase& base, const RefineLogs& logs,
                                       const std::string& why);

}  // namespace cablefit
