#include "simulate.hpp"

#include <algorithm>
#include <cmath>

#include "random.hpp"
#include "step.hpp"

namespace hidden {
namespace {

constexpr int kSettle = 500;        // samples before t = 0
constexpr double kSlowNoise = 0.2;  // s

double counts(double x, double quantum) {
  return quantum > 0 ? quantum * std::round(x / quantum) : x;
}

/// The hooks that are there, so that the hot loop asks nothing of those that are not.
struct Active {
  std::vector<const std::function<double(const State&)>*> deflection, transmission;
  std::vector<const std::function<void(const State&, Sides&)>*> sides;
  std::vector<const std::function<void(const State&)>*> advance;

  explicit Active(const std::vector<Hooks>& hooks) {
    for (const bool last : {false, true}) {
      for (const Hooks& one : hooks) {
        if (one.replaces_coulomb != last) continue;
        if (one.deflection) deflection.push_back(&one.deflection);
        if (one.transmission) transmission.push_back(&one.transmission);
        if (one.sides) sides.push_back(&one.sides);
        if (one.advance) advance.push_back(&one.advance);
      }
    }
  }
};

struct Motion {
  double q = 0, qd = 0, theta = 0, thetad = 0;
};

class Plant {
 public:
  Plant(const Bench& bench, const std::vector<Hooks>& hooks, bool blocked, double load)
      : rig_(bench.rig), active_(hooks), blocked_(blocked), load_((1 + bench.load_scale) * load) {}

  void step(Motion& now, double tau, double t, double h) const {
    Slide link{now.qd, now.qd * h}, motor{now.thetad, now.thetad * h};
    State mid;
    for (int pass = 0; pass < 2; ++pass) {
      mid = middle(now, link, motor, t, h);
      const Sides sides = resist(mid);
      link = blocked_ ? Slide{}
                      : advance(now.qd, rig_.J_link, rig_.f_v, mid.tau_elas + load_, sides.link, h);
      motor = advance(now.thetad, rig_.J_motor, rig_.f_vm, tau - rig_.offset - mid.tau_elas,
                      sides.motor, h);
    }
    now = {now.q + link.dx, link.v, now.theta + motor.dx, motor.v};
    for (const auto* hook : active_.advance) (*hook)(mid);
  }

 private:
  static Slide advance(double v, double J, double f, double torque, const Side& side, double h) {
    return slide(v, J + side.inertia, f + side.viscous, torque - side.torque,
                 std::max(0.0, side.down), std::max(0.0, side.up), h);
  }

  State middle(const Motion& now, const Slide& link, const Slide& motor, double t, double h) const {
    State s;
    s.t = t + 0.5 * h;
    s.h = h;
    s.q = now.q + 0.5 * link.dx;
    s.theta = now.theta + 0.5 * motor.dx;
    s.qd = link.dx / h;
    s.thetad = motor.dx / h;
    s.phi = s.theta - s.q;
    s.phid = s.thetad - s.qd;
    s.load = load_;
    double phi = s.phi;
    for (const auto* hook : active_.deflection) phi += (*hook)(s);
    s.tau_elas = rig_.tau_elas(phi);
    if (!active_.sides.empty() || !active_.advance.empty()) {
      s.tension = rig_.tension(phi);
      s.stiffness = rig_.stiffness(phi);
    }
    for (const auto* hook : active_.transmission) s.tau_elas += (*hook)(s);
    return s;
  }

  Sides resist(const State& s) const {
    Sides sides{{0, rig_.f_s, rig_.f_s}, {0, rig_.f_sm, rig_.f_sm}};
    for (const auto* hook : active_.sides) (*hook)(s, sides);
    return sides;
  }

  Rig rig_;
  Active active_;
  bool blocked_;
  double load_;
};

/// The digital controller and the drive, which may answer late.
class Drive {
 public:
  Drive(const Bench& bench, double reference, double theta)
      : bench_(bench), last_reference_(reference), last_theta_(theta) {}

  /// The command (N m) for the measured theta; acts from now on, or later.
  double command(double reference, double theta) {
    const double rate = (reference - last_reference_) - (theta - last_theta_);
    const double tau = bench_.kp * (reference - theta) + bench_.kd * rate * kRate;
    last_reference_ = reference;
    last_theta_ = theta;
    const double limited = std::clamp(tau, -bench_.limit, bench_.limit);
    acts_.push_back(bench_.drive ? bench_.drive(limited) : limited);
    return limited;
  }

  /// What acts in substep `i` of the newest sample, `late` substeps after it was commanded.
  double torque(int i, int late, int substeps) const {
    const int back = late <= i ? 0 : (late - i + substeps - 1) / substeps;
    const auto newest = static_cast<int>(acts_.size()) - 1;
    return acts_[static_cast<std::size_t>(std::max(0, newest - back))];
  }

 private:
  const Bench& bench_;
  double last_reference_, last_theta_;
  std::vector<double> acts_;
};

Motion balance(const Bench& bench, const Run& run) {
  const double reference = run.reference.front();
  if (run.blocked) return {0, 0, 0, 0};
  const double phi = deflection_for(bench.rig, -run.load);
  const double theta = reference - (bench.rig.offset - run.load) / bench.kp;
  return {theta - phi, 0, theta, 0};
}

Bench altered(Bench bench, const std::vector<Hooks>& hooks, const Run& run) {
  if (run.l_o != 0) bench.rig = preloaded(bench.rig, run.l_o);
  for (const Hooks& one : hooks)
    if (one.alter) one.alter(bench);
  return bench;
}

}  // namespace

Recording simulate(const Bench& given, const std::vector<Hooks>& hooks, const Run& run,
                   int substeps) {
  const Bench bench = altered(given, hooks, run);
  const Plant plant(bench, hooks, run.blocked, run.load);
  const double h = 1 / (kRate * substeps);
  const auto steps = [&](double delay) { return static_cast<int>(std::lround(delay / h)); };
  const int q_late = steps(bench.q_delay), tau_late = steps(bench.tau_delay);

  Motion now = balance(bench, run);
  const auto encoder = [&] { return (now.theta - bench.theta_offset) / (1 + bench.theta_scale); };
  Drive drive(bench, run.reference.front(), counts(encoder(), bench.quantum_theta));
  std::vector<double> past_q(static_cast<std::size_t>(q_late) + 1, now.q);  // a ring
  std::size_t newest = 0;
  Random noise(run.noise, run.name), slow(run.noise, run.name + " slow");
  const double keeps = std::exp(-1 / (kRate * kSlowNoise));
  double disturbance = slow.normal();

  Recording out;
  const auto n = static_cast<int>(run.reference.size());
  for (int k = -kSettle; k < n; ++k) {
    const double reference = run.reference[static_cast<std::size_t>(std::max(0, k))];
    const double theta = encoder();
    const double q = past_q[(newest + 1) % past_q.size()];
    const double tau = drive.command(reference, counts(theta, bench.quantum_theta));
    if (k >= 0) {
      const auto record = [&](Signals& to, double q_shown, double theta_shown, double tau_shown) {
        to.q.push_back(q_shown);
        to.theta.push_back(theta_shown);
        to.tau.push_back(tau_shown);
        to.theta_ref.push_back(reference);
      };
      record(out.exact, q, theta, tau);
      record(out.logged, counts(q, bench.quantum_q), counts(theta, bench.quantum_theta),
             tau + bench.noise_tau * noise.normal() + bench.slow_noise_tau * disturbance);
      disturbance = keeps * disturbance + std::sqrt(1 - keeps * keeps) * slow.normal();
    }
    for (int i = 0; i < substeps; ++i) {
      plant.step(now, drive.torque(i, tau_late, substeps), k / kRate + i * h, h);
      past_q[newest = (newest + 1) % past_q.size()] = now.q;
    }
  }
  const Rig as_known = run.l_o != 0 ? preloaded(given.rig, run.l_o) : given.rig;
  for (Signals* signals : {&out.exact, &out.logged}) {
    signals->load = run.load;
    signals->blocked = run.blocked;
    signals->l_o_1 = as_known.cable_1.l_o;
    signals->l_o_2 = as_known.cable_2.l_o;
  }
  return out;
}

}  // namespace hidden
