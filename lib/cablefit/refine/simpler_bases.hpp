// What refine begins with where the training samples do not determine its own base.
#pragma once

#include <string>
#include <vector>

#include "cablefit/refine/own_base.hpp"

namespace cablefit {

struct SimplerBase {
  OwnBase base;
  std::string warning;  ///< what may come of it
};

/// Bases with less to determine, in the order in which to try them. First, of a plain pair of
/// cables (none in the rig file), the less loaded one with one coefficient, then without it; then
/// one straight spring. None without cables, and none of several joints: a spring per joint is not
/// what cables do that pass several. The decisions say `why`.
std::vector<SimplerBase> simpler_bases(const OwnBase& base, const RefineLogs& logs,
                                       const std::string& why);

}  // namespace cablefit
