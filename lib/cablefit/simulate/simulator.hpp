// Forward simulation of a model: rigid or elastic joints, set-valued Coulomb friction (true stick,
// no chatter), slack cables, torque held over the drive's period. Torque replay or closed loop.
//
// Method: position Verlet with friction solved as a set-valued law. A step of length h is
//
//   x_mid = x + h/2 v,   J v' in F(x_mid) - d v - level Sgn(v) over h,   x' = x_mid + h/2 v'
//
// with elastic, load and motor torque F frozen at the midpoint and friction linearised in v by the
// trapezoidal rule. Within the step a body that comes to rest stops, and leaves again only when F
// exceeds `level`: it stands exactly still otherwise (Moreau 1988, "Unilateral contact and dry
// friction"; the stop is placed inside the step, so that reversals keep the order). Second order in
// h, through stops, reversals and cables that go slack too. Explicit in the elastic torque: stable
// for h < 2/omega of the stiffest mode (paper's rig: 350 to 630 rad/s, h omega < 0.016 at 25 us).
//
// Links of a coupled arm advance together, M(q) (v' - v) in the place of J (v' - v), by the same
// scheme and to the same order (coupled_links.hpp).
//
// Refinements of the model act as torques at the midpoint, with velocities extrapolated to it, and
// as more (or less) dry friction of their axis. Those that correct a recording give what acts of a
// controller's commands; a replayed torque has to be corrected before (part_replay.hpp).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Uniform input of one segment, rows x joints, SI.
struct SimulationInput {
  double period = 0;          ///< s, of the rows
  Eigen::ArrayXXd tau;        ///< N m; replayed when the loop is open
  Eigen::ArrayXXd tau_load;   ///< N m; used when the rig has no load law of q
  Eigen::ArrayXXd theta_ref;  ///< rad; closed loop only
  /// N m, unknown torques added on motor (or rigid drive) and link; linear between rows, none when
  /// empty.
  Eigen::ArrayXXd motor_disturbance, link_disturbance;
  Eigen::VectorXd q0, qd0, theta0, thetad0;  ///< initial state
  double t0 = 0;               ///< s since the log began, of the first row; for refinements
  std::size_t log_number = 0;  ///< from 0; for refinements with a date
};

struct SimulationOptions {
  double step = 25e-6;        ///< s, upper limit; divided so that a row is a whole number of steps
  bool closed_loop = false;   ///< uses rig.controller (torque period: the controller's)
  bool hold_torque = true;    ///< tau held over a row (zoh), else linear between rows
  bool link_blocked = false;  ///< the link is held at q0, as in stage 1; not on a rigid drive
};

/// State at every row: positions rad, velocities rad/s, tension per cable (N; joint space N m), and
/// the motor torque N m commanded from the row on; rows x joints (cables). Linear model: no cables.
struct SimulationResult {
  Eigen::ArrayXXd q, theta, qd, thetad, tau, tension;
  /// First row at which a state was no longer finite or left +-1e6; rows from there on are NaN.
  std::optional<Eigen::Index> diverged_at;
};

/// Never throws for a model that diverges (see diverged_at); a model without a positive inertia on
/// every axis, or positive definite M(q), has diverged at row 0. On a rigid drive q equals theta in
/// the result and the load torque is added to tau. A controller whose period is no whole number of
/// steps acts at the step nearest to its time. Throws Error(input) for a closed loop without
/// rig.controller.
SimulationResult simulate(const Model& model, const SimulationInput& input,
                          const SimulationOptions& options);

/// The same over a log of any length, block by block, with the same bits as in one go.
class Simulation {
 public:
  /// Takes the initial state, the period and the first references from `start`. Throws as above.
  Simulation(const Model& model, const SimulationInput& start, const SimulationOptions& options);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// For one that restarts where `before` ended, of the same model: what cables and friction
  /// keep as state (creep, hysteresis, presliding) continues instead of starting from 0.
  void take_history(const Simulation& before);

  /// Rows [0, n_rows) of `block`, whose row 0 comes right after the last row of the call before;
  /// its initial state is not looked at. Where another block follows, this one must have its first
  /// row as a row more than n_rows: the simulation steps on to there, and what is linear between
  /// rows needs it. After a divergence nothing more may be simulated.
  SimulationResult run(const SimulationInput& block, Eigen::Index n_rows);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Agreement of a simulated with a measured signal over the rows of a segment.
struct Gap {
  double rms = 0, max_abs = 0;
  double relative = 0;  ///< rms / rms of the measured signal about its mean; that 0: inf or NaN
};
Gap gap(const Eigen::Ref<const Eigen::ArrayXd>& measured,
        const Eigen::Ref<const Eigen::ArrayXd>& simulated);

}  // namespace cablefit
