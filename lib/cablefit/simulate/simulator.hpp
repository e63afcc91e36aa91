// Forward simulation of a model: rigid or elastic joints, set-valued Coulomb friction (true stick,
// no chatter), slack cables, torque held over the drive's period. Torque replay or closed loop.
//
// Method: position Verlet with friction solved as a set-valued law. A step of length h is
//
//   x_mid = x + h/2 v,   J v' in F(x_mid) - d v - level Sgn(v) over h,   x' = x_mid + h/2 v'
//
// with elastic, load and motor torque F frozen at the midpoint and friction linearised in v by the
// trapezoidal rule. A body that comes to rest within the step stops there, so that reversals keep
// the order. It moves again only when F exceeds `level`; until then it is exactly at rest (Moreau
// 1988, "Unilateral contact and dry friction"). The scheme is of second order in h, also at stops,
// reversals and where cables go slack. It is explicit in the elastic torque, so it is stable for h
// < 2/omega of the stiffest mode (paper's rig: 350 to 630 rad/s, h omega < 0.016 at 25 us).
//
// Links of a coupled arm advance together, with M(q) (v' - v) in the place of J (v' - v). The
// scheme and its order are the same (coupled_links.hpp).
//
// Effects beyond the base model act as torques at the midpoint, with velocities extrapolated to it,
// and as more (or less) dry friction of their axis. An effect that corrects a recording changes a
// controller's commands to the torque that acts. A replayed torque must be corrected before
// (part_replay.hpp).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Input of one segment on an even grid, rows x joints, SI.
struct SimulationInput {
  double period = 0;          ///< s, of the rows
  Eigen::ArrayXXd tau;        ///< N m; replayed when the loop is open
  Eigen::ArrayXXd tau_load;   ///< N m; used when the rig has no load law of q
  Eigen::ArrayXXd theta_ref;  ///< rad; closed loop only
  /// N m, unknown torques on the motor (or rigid drive) and the link, linear between rows. Empty:
  /// none.
  Eigen::ArrayXXd motor_disturbance, link_disturbance;
  Eigen::VectorXd q0, qd0, theta0, thetad0;  ///< initial state
  double t0 = 0;  ///< s since the log began, of the first row; for effects that depend on time
  std::size_t log_number = 0;  ///< from 0; for events
};

struct SimulationOptions {
  double step = 25e-6;        ///< s, upper limit; reduced so that a row is a whole number of steps
  bool closed_loop = false;   ///< uses rig.controller (torque period: the controller's)
  bool hold_torque = true;    ///< tau held over a row (zoh), else linear between rows
  bool link_blocked = false;  ///< the link is held at q0, as in stage 1; not on a rigid drive
};

/// State at every row: positions rad, velocities rad/s, tension per cable (N; joint space N m), and
/// the motor torque (N m) commanded from that row on. Rows x joints (cables). Linear model: no
/// cables.
struct SimulationResult {
  Eigen::ArrayXXd q, theta, qd, thetad, tau, tension;
  /// First row at which a state was not finite or beyond +-1e6. From there on rows are NaN.
  std::optional<Eigen::Index> diverged_at;
};

/// Never throws for a model that diverges (see diverged_at). A model without a positive inertia on
/// every axis, or without a positive definite M(q), diverges at row 0. On a rigid drive q equals
/// theta in the result, and the load torque is added to tau. A controller whose period is no whole
/// number of steps acts at the step nearest to its time. Throws Error(input) for a closed loop
/// without rig.controller.
SimulationResult simulate(const Model& model, const SimulationInput& input,
                          const SimulationOptions& options);

/// The same over a log of any length, block by block, with the same bits as in one call.
class Simulation {
 public:
  /// Takes the initial state, the period and the first references from `start`. Throws as above.
  Simulation(const Model& model, const SimulationInput& start, const SimulationOptions& options);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// For a simulation of the same model that restarts where `before` ended. The states of cables
  /// and friction (creep, hysteresis, presliding) continue instead of starting from 0.
  void take_history(const Simulation& before);

  /// Simulates rows [0, n_rows) of `block`. Its row 0 follows the last row of the previous call,
  /// and its initial state is ignored. Where another block follows, this one must have the first
  /// row of that block as an extra row: the simulation steps on to that row, and linear
  /// interpolation needs it. Do not call it after a divergence.
  SimulationResult run(const SimulationInput& block, Eigen::Index n_rows);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// Agreement of a simulated with a measured signal over the rows of a segment.
struct Gap {
  double rms = 0, max_abs = 0;
  double relative = 0;  ///< rms / rms of the measured signal about its mean (0: inf or NaN)
};
Gap gap(const Eigen::Ref<const Eigen::ArrayXd>& measured,
        const Eigen::Ref<const Eigen::ArrayXd>& simulated);

}  // namespace cablefit
