// Truth simulator of a rigid drive, for Monte Carlo runs by the thousand. Shares no code with the
// library.
//
//   J thetadd + f_v thetad + f_s sgn(thetad) + offset = tau + disturbance
//
// SI, after the reduction, as in rig.hpp.
#ifndef CABLEFIT_TESTS_TRUTH_DRIVE_HPP_
#define CABLEFIT_TESTS_TRUTH_DRIVE_HPP_

#include "rig.hpp"

namespace truth {

// Sizes of Fichera & Grossard 2017, Table 2 ("low, poly"), motor and link as one body.
struct Drive {
  double J = 0.339 + 0.0133;    // kg m^2
  double f_v = 5.601 + 1.0654;  // N m s/rad
  double f_s = 3.274 + 2.778;   // N m; also the break-away torque
  double offset = 0.0286;       // N m
};

struct DriveOptions : CommonOptions {
  DriveOptions() { fine_rate = 10000.0; }
  double slow_peak = 0.5;         // as in MovingOptions
  double fast_accel = 150.0;      // rad/s^2
  double disturbance_sd = 1.0;    // N m, Ornstein-Uhlenbeck, not logged
  double disturbance_time = 0.1;  // its correlation time, s; far below the log period: white
  // The disturbance is one of the torque sensor: it is in the logged torque and moves nothing.
  bool on_sensor = false;
  // The torque of a run of the same controller without disturbance and with ideal sensors is
  // replayed: nothing of the disturbance comes back through the controller.
  bool open_loop = false;
};

// The reference is a random-phase multi-sine from rest. Columns t, theta, tau and, in closed loop,
// theta_ref; the others stay empty. quantum_q is not used. Throws std::invalid_argument on options
// that make no sense.
Log simulate_drive(const Drive& drive, const DriveOptions& options);

}  // namespace truth

#endif  // CABLEFIT_TESTS_TRUTH_DRIVE_HPP_
