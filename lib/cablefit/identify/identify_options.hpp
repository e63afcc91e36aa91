// What the one step is asked for.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

/// Which initial elongations are searched. `automatic`: those for which the rig file says
/// "search"; and without cables in the rig files, all of several preloads (one alone is taken as
/// 0).
enum class ElongationMode { automatic, search, known };

struct IdentifyOptions {
  SampleOptions samples;
  int order = 0;  ///< of the cables' force; 0: the rig file's, else 2
  ElongationMode elongations = ElongationMode::automatic;
  std::string search_reason = "given";  ///< why all are searched, when they are
  bool unconstrained = false;           ///< a negative cable stiffness is allowed
  bool robust_sd = true;                ///< --sd honest | white
  std::string preload;                  ///< only this one; empty: all
  bool recursive = false;               ///< R-LSA beside the direct fit: its trace
  bool figures = false;
  /// What the joint has beyond the paper's (31), with values to start from.
  std::vector<EffectInstance> effects = {};
};

}  // namespace cablefit
