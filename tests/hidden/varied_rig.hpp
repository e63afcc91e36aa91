// Effect-free rigs of every size, logged in every way: a finger of 0.02 N m or an arm of 200 N m,
// 250 Hz to 2 kHz, a mean of the torque or every second, fourth or each command of the drive. The
// rig file says nothing of it. What a tool finds there is made by the tool.
#pragma once

#include <cstdint>
#include <filesystem>

namespace hidden {

/// Writes blocked.csv, four moving logs, rig.json and truth.json into `folder` (made if need be).
void write_varied_rig(const std::filesystem::path& folder, std::uint64_t seed);

}  // namespace hidden
