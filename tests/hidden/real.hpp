// A known torque planted into the measured tau of a log that somebody else recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "real_log.hpp"

namespace hidden {

/// A set of real logs below the folder of shared data.
struct RealSet {
  std::string_view name, folder;
  std::vector<std::string_view> train, test;  ///< files; without test the tool holds out parts
  bool blocked;                               ///< an actuator on a spring, its output held
  int half_window;                            ///< samples each side of the parabolas that smooth
  std::string_view rig;                       ///< rig.json
};
const std::vector<RealSet>& real_sets();

/// What friction, ripple or hysteresis would have asked of the motor on top, at size 1. `u`, `w` in
/// 0..1 choose phases and the like; lengths and speeds go by `scale`.
struct RealScale {
  double range = 1, speed = 1;  ///< largest |x - mean| and rms speed of the training logs
};
struct RealEffect {
  std::string_view name, side;
  bool moving, blocked;  ///< in which kind of set it can be seen
  Eigen::VectorXd (*torque)(const Track& x, const RealScale& scale, double u, double w);
};
const std::vector<RealEffect>& real_effects();

/// What a case plants: its rms is `ratio` times the rms of what the base model leaves on the
/// untouched training logs.
struct RealSpec {
  std::string set, effect;
  double ratio = 1;
  std::uint64_t seed = 1;
};

/// Writes the altered logs, the rig file and truth.json into `folder`. Throws std::invalid_argument
/// on a name that is not in the tables, std::runtime_error when the logs are not there.
void plant_real(const std::filesystem::path& data, const RealSpec& spec,
                const std::filesystem::path& folder);

}  // namespace hidden
