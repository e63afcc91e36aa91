// The rig file of a log of the truth simulator's rigid drive.
#pragma once

#include "cablefit/model/rig.hpp"
#include "tests/truth/drive.hpp"

namespace cablefit::test {

/// The controller is known, or the torque is a command, or neither where the disturbance is one of
/// the sensor: as in DriveOptions.
inline Rig drive_rig(const truth::DriveOptions& options) {
  Rig rig = default_rig();
  rig.torque_hold = TorqueHold::zoh;
  rig.sensors["theta"].quantum = options.quantum_theta;
  rig.sensors["tau"].noise = options.noise_tau;
  rig.open_loop = options.open_loop && !options.on_sensor;
  if (options.open_loop) return rig;
  rig.controller.emplace();
  rig.controller->kp = options.kp;
  rig.controller->kd = options.kd;
  rig.controller->limit = options.limit;
  return rig;
}

/// The same rig file without a word on where the torque comes from.
inline Rig silent_drive_rig(const truth::DriveOptions& options) {
  Rig rig = drive_rig(options);
  rig.controller.reset();
  rig.open_loop = false;
  return rig;
}

}  // namespace cablefit::test
