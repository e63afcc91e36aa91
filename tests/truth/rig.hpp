// Truth simulator: one cable-driven joint with two antagonist cables, simulated finely enough to
// serve as a known answer for tests and example logs. Shares no code with the library.
//
//   J_link  * qdd     + f_v  * qd     + f_s  * sgn(qd)              = tau_elas(theta - q) +
//   tau_load J_motor * thetadd + f_vm * thetad + f_sm * sgn(thetad) + offset = tau - tau_elas(theta
//   - q)
//
// All quantities are SI, motor quantities after the reduction: rad, rad/s, N m, kg m^2, s.
// A positive deflection theta - q stretches cable 1 and pulls the link in the positive direction.
#ifndef CABLEFIT_TESTS_TRUTH_RIG_HPP_
#define CABLEFIT_TESTS_TRUTH_RIG_HPP_

#include <cstdint>
#include <string>
#include <vector>

namespace truth {

// A cable in joint space: torque(l) = c[0] l + c[1] l^2 + c[2] l^3 + ... for an elongation l > 0,
// zero otherwise: a cable only pulls.
struct Cable {
  std::vector<double> stiffness;    // c[k] in N m / rad^(k+1), any number of orders
  double initial_elongation = 0.0;  // l_o (rad), the elongation at zero deflection; >= 0 is preload

  // Torque (N m, >= 0) at the elongation l (rad, initial elongation included).
  double torque(double l) const;
};

// The plant. Defaults are the parameters of Rig::low().
struct Rig {
  double J_link = 0.339;    // kg m^2
  double J_motor = 0.0133;  // kg m^2
  double f_v = 5.601;       // link viscous friction, N m s/rad
  double f_s = 3.274;       // link Coulomb friction, N m; also the break-away torque
  double f_vm = 1.0654;     // motor viscous friction, N m s/rad
  double f_sm = 2.778;      // motor Coulomb friction, N m; also the break-away torque
  double offset = 0.0286;   // constant motor torque, N m
  Cable cable_1;            // elongation l =  phi + l_o
  Cable cable_2;            // elongation l = -phi + l_o

  // Fichera & Grossard 2017: cables of Table 1 (low preload, polynomial), dynamics of Table 2
  // ("low, poly" column), l_o = 0.
  static Rig low();
  // The same cables stretched by l_o = 5.12 mrad and the elongation that balances it (4.67 mrad);
  // dynamics of Table 2 ("high, poly" column).
  static Rig high();

  // Elastic torque on the link (N m) at the deflection phi = theta - q (rad).
  double tau_elas(double phi) const;
  // True when both cables are taut (force closure) at the deflection phi (rad).
  bool in_closure(double phi) const;
  // Deflection (rad) at which the elastic torque is `torque` (N m). Throws std::invalid_argument
  // if no deflection within +-1 rad gives it.
  double deflection_for(double torque) const;
};

// Elongation (rad, >= 0) at which `cable` pulls with `torque` (N m, >= 0): used to balance a
// preload.
double elongation_for(const Cable& cable, double torque);

// What a recorder sees. All columns have one entry per sample; columns that a recording does not
// have are empty.
struct Log {
  std::vector<double> t;          // s, starts at 0
  std::vector<double> q;          // link position, quantised, rad
  std::vector<double> theta;      // motor position, quantised, rad
  std::vector<double> tau;        // commanded at t and held until the next command, plus noise, N m
  std::vector<double> tau_load;   // known external torque on the link, N m (empty: blocked)
  std::vector<double> theta_ref;  // reference of the controller, rad (empty: blocked)
};

// What really happened at the same samples: neither quantised nor noisy.
struct Truth {
  std::vector<double> q, theta;     // rad
  std::vector<double> qd, thetad;   // rad/s, exactly zero while stuck
  std::vector<double> tau;          // torque applied from this sample on, N m
  std::vector<double> tau_elas;     // N m
  std::vector<double> disturbance;  // unknown torque on the link, N m
  std::vector<double> theta_ref;    // rad
};

// Recorder, controller and integrator settings shared by both experiments. The controller is
//   tau = kp (ref_k - theta_k) + kd ((ref_k - ref_{k-1}) - (theta_k - theta_{k-1})) / T,
// on the quantised theta, clamped to +-limit and held over the control period T.
struct CommonOptions {
  double duration = 16.0;         // s
  double rate = 1000.0;           // log rate, Hz
  double control_period = 0.0;    // s; 0: the log period. Must be a multiple of the fine step
  double fine_rate = 40000.0;     // integration rate, Hz, rounded to a multiple of the log rate
  std::uint64_t seed = 1;         // reference phases, noise and disturbance
  double kp = 800.0;              // N m/rad
  double kd = 6.0;                // N m s/rad
  double limit = 250.0;           // N m
  double noise_tau = 0.3;         // sd of the white noise on the logged torque, N m
  double quantum_q = 6e-6;        // rad; 0: no quantisation
  double quantum_theta = 2.4e-5;  // rad; 0: no quantisation (also seen by the controller)
};

struct MovingOptions : CommonOptions {
  double load = 0.0;              // constant tau_load, N m
  double slow_peak = 0.5;         // largest excursion of the slow part (0.1..2 Hz), rad
  double fast_accel = 220.0;      // rms acceleration of the fast part (4..45 Hz), rad/s^2
  double disturbance_sd = 0.0;    // Ornstein-Uhlenbeck torque on the link, not logged, N m
  double disturbance_time = 0.1;  // its correlation time, s
};

struct BlockedOptions : CommonOptions {
  BlockedOptions();
  double range = 0.045;      // sweeps between +-range, rad of deflection
  double period = 8.0;       // mean duration of a sweep up and down, s
  double speed_depth = 0.5;  // relative variation of the sweep speed, [0, 1)
  bool plateaus = false;     // stop at 16 levels per sweep instead of moving on
};

// Link free, motor follows a random-phase multi-sine that starts in static equilibrium with the
// load. `truth` (optional) receives the exact signals. Throws std::invalid_argument on options that
// make no sense.
Log simulate_moving(const Rig& rig, const MovingOptions& options, Truth* truth = nullptr);

// Link held at q = 0, motor swept slowly. The reference contains the static torque divided by kp,
// so that a pure PD controller reaches the wanted range. tau_load and theta_ref stay empty.
Log simulate_blocked(const Rig& rig, const BlockedOptions& options, Truth* truth = nullptr);

// Writes the columns that are not empty with a header line; positions to 1e-6 rad, torques to
// 1e-3 N m, t to 1e-9 s, without trailing zeros. Throws std::runtime_error if the file cannot be
// written.
void write_csv(const std::string& path, const Log& log);

}  // namespace truth

#endif  // CABLEFIT_TESTS_TRUTH_RIG_HPP_
