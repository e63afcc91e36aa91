// Effect-free rigs, logged as a user's bench would: the controller is not written down, tau is the
// drive's current (a mean over a millisecond, not the command), its noise is partly slow, and the
// motion is what people record: steps between poses, holds, a slow and a fast multisine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "plant.hpp"

namespace hidden {

struct UserSpec {
  std::string preload = "low";  ///< "low": l_o = 0; "high": both cables taut over the whole range
  std::uint64_t seed = 1;       ///< rig, motion, noise
  double seconds = 60;          ///< of the moving log; the blocked one has 40 s at half the rate
  double rate = 1000;           ///< Hz, of the moving log; divides 1000
  double torque_mean = 1e-3;    ///< s, the current is a mean over this, centred on t
  double white = 0.30, coloured = 0.08;  ///< N m, sd of the torque noise; coloured: 0.2 s
  double quantum_q = 6e-6, quantum_theta = 2.4e-5;  ///< rad
  double l_o = 0;            ///< rad, of cable 1 at the low preload, hidden: balanced by cable 2
  double lost = 0;           ///< share of the moving log's rows that is missing
  double stamp_jitter = 0;   ///< s, sd: the samples are even, their time stamps are not
  double sample_jitter = 0;  ///< s, sd: the samples are uneven, as their time stamps say
  bool controller = false;   ///< the rig file has the controller and the moving log its reference
};

/// What a fit with l_o = 0 can find: the rig, and the curve of the elastic torque about zero as the
/// coefficients of (30), N m/rad and N m/rad^2.
struct UserTruth {
  Rig rig;
  double K1_0 = 0, K1_1 = 0, K2_0 = 0, K2_1 = 0;
};

/// Writes moving.csv, blocked.csv, rig.json and truth.json into `folder` (made if need be).
void write_user_rig(const std::filesystem::path& folder, const UserSpec& spec);

}  // namespace hidden
