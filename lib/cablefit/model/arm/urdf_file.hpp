// Reading a URDF: an optional component, since only this needs an XML library. That is tinyxml2
// alone and not urdfdom, which prints to stderr through a global of another library, names no lines
// and has no limit on how deep elements nest; a test compares the torques of arms with KDL's.
#pragma once

#include "cablefit/model/arm/urdf_tree.hpp"

namespace cablefit {

/// Whether this build can.
bool reads_urdf();

/// Links, joints and inertias; meshes and whatever else a URDF holds are passed over, no other file
/// is opened. Throws Error(input) at file:line: no file, no XML, more than 4 MB, names that are
/// missing, unknown or taken, numbers that are none, links that form no tree.
UrdfTree read_urdf(const std::string& path);

}  // namespace cablefit
