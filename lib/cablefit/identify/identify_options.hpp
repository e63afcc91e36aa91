// Options of the one-step identification.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

/// Which initial elongations are searched. `automatic`: those for which the rig file says "search".
/// Without cables in the rig files, all of several preloads; the l_o of a single preload is taken
/// as 0.
enum class ElongationMode { automatic, search, known };

struct IdentifyOptions {
  SampleOptions samples;
  int order = 0;  ///< of the cables' force; 0: the rig file's, else 2
  ElongationMode elongations = ElongationMode::automatic;
  std::string search_reason = "given";  ///< why all are searched, when they are
  bool unconstrained = false;           ///< allows a negative cable stiffness
  bool robust_sd = true;                ///< --sd honest | white
  std::string preload;                  ///< only this one; empty: all preloads
  bool recursive = false;               ///< also the trace of R-LSA, beside the direct fit
  bool figures = false;
  EffectsPerJoint effects = {};  ///< beyond the paper's (31), with start values
};

}  // namespace cablefit
