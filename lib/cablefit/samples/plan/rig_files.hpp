// Whether the rig files of two logs say the same.
#pragma once

#include "cablefit/model/rig.hpp"

namespace cablefit {

/// The rig files, as they are on disk: of the same content; equal but for "load"; different.
enum class RigDifference { none, load, other };
RigDifference compare_rig_files(const Rig& a, const Rig& b);

}  // namespace cablefit
