// Whether the rig files of two logs say the same.
#pragma once

#include <string>

#include "cablefit/model/rig.hpp"

namespace cablefit {

enum class RigDifference { none, load, other };

/// Of rig files as they are on disk. Their "name" is only a label.
struct RigComparison {
  RigDifference difference = RigDifference::none;
  std::string key;  ///< of other differences the first one's, e.g. "cables"; empty: one has no file
};
RigComparison compare_rig_files(const Rig& a, const Rig& b);

}  // namespace cablefit
