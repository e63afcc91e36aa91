#include "rig.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "parts.hpp"

namespace truth {
namespace {

// Smallest x in [lo, hi] where the non-decreasing f reaches zero.
double bisect(const std::function<double(double)>& f, double lo, double hi) {
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (lo + hi);
    (f(mid) < 0.0 ? lo : hi) = mid;
  }
  return hi;
}

// Motor and link, integrated with the midpoint of the positions: second order in h while neither
// body starts or stops.
class Plant {
 public:
  Plant(const Rig& rig, bool blocked, double theta)
      : rig_(rig),
        link_{rig.J_link, rig.f_v, rig.f_s},
        motor_{rig.J_motor, rig.f_vm, rig.f_sm},
        blocked_(blocked),
        theta_(theta) {}

  // tau: motor torque, external: all torque on the link besides the cables; N m.
  void step(double tau, double external, double h) {
    const double q_mid = q_ + 0.5 * h * qd_;
    const double theta_mid = theta_ + 0.5 * h * thetad_;
    const double elastic = rig_.tau_elas(theta_mid - q_mid);
    thetad_ = motor_.advance(thetad_, tau - elastic - rig_.offset, h);
    theta_ = theta_mid + 0.5 * h * thetad_;
    if (blocked_) return;
    qd_ = link_.advance(qd_, elastic + external, h);
    q_ = q_mid + 0.5 * h * qd_;
  }

  double q() const { return q_; }
  double qd() const { return qd_; }
  double theta() const { return theta_; }
  double thetad() const { return thetad_; }
  double tau_elas() const { return rig_.tau_elas(theta_ - q_); }

 private:
  const Rig& rig_;
  Body link_;
  Body motor_;
  bool blocked_;
  double q_ = 0.0;
  double qd_ = 0.0;
  double theta_;
  double thetad_ = 0.0;
};

// Steps of the three clocks: fine step, log period, control period.
struct Clock {
  double h;
  int steps_per_sample;
  long steps_per_command;
  long samples;
};

Clock make_clock(const CommonOptions& o) {
  if (!(o.duration > 0.0 && o.rate > 0.0 && o.fine_rate >= o.rate && o.control_period >= 0.0)) {
    throw std::invalid_argument("duration, rate, fine_rate and control_period do not fit together");
  }
  Clock clock{};
  clock.steps_per_sample = static_cast<int>(std::lround(o.fine_rate / o.rate));
  clock.h = 1.0 / (o.rate * clock.steps_per_sample);
  clock.samples = std::lround(o.duration * o.rate);
  const double period = o.control_period > 0.0 ? o.control_period : 1.0 / o.rate;
  clock.steps_per_command = std::lround(period / clock.h);
  const double left_over = period / clock.h - static_cast<double>(clock.steps_per_command);
  if (clock.steps_per_command < 1 || std::abs(left_over) > 1e-6) {
    throw std::invalid_argument("control_period is not a multiple of the fine step");
  }
  return clock;
}

// Everything that differs between the two experiments.
struct Experiment {
  bool blocked;
  double load;         // N m
  double theta_start;  // rad
  Disturbance disturbance;
  std::function<double(double)> reference;  // rad over s
};

void record_truth(const Plant& plant, double tau, double disturbance, double reference,
                  Truth* truth) {
  if (truth == nullptr) return;
  truth->q.push_back(plant.q());
  truth->theta.push_back(plant.theta());
  truth->qd.push_back(plant.qd());
  truth->thetad.push_back(plant.thetad());
  truth->tau.push_back(tau);
  truth->tau_elas.push_back(plant.tau_elas());
  truth->disturbance.push_back(disturbance);
  truth->theta_ref.push_back(reference);
}

void record_log(const Plant& plant, const CommonOptions& options, const Experiment& experiment,
                double t, double measured_tau, double reference, Log* log) {
  log->t.push_back(t);
  log->q.push_back(quantise(plant.q(), options.quantum_q));
  log->theta.push_back(quantise(plant.theta(), options.quantum_theta));
  log->tau.push_back(measured_tau);
  if (experiment.blocked) return;
  log->tau_load.push_back(experiment.load);
  log->theta_ref.push_back(reference);
}

Log run(const Rig& rig, const CommonOptions& options, Experiment experiment, Truth* truth) {
  if (truth != nullptr) *truth = Truth{};
  const Clock clock = make_clock(options);
  const auto reference_at = [&](double t) {
    return quantise(experiment.reference(t), kReferenceQuantum);
  };
  Plant plant(rig, experiment.blocked, experiment.theta_start);
  PdController controller(options, clock.h * static_cast<double>(clock.steps_per_command),
                          reference_at(0.0), quantise(plant.theta(), options.quantum_theta));
  Random noise = stream(options.seed, kNoiseStream);
  Log log;
  double reference = 0.0;
  double tau = 0.0;
  long step = 0;
  for (long sample = 0; sample < clock.samples; ++sample) {
    for (int sub = 0; sub < clock.steps_per_sample; ++sub, ++step) {
      if (step % clock.steps_per_command == 0) {
        reference = reference_at(static_cast<double>(step) * clock.h);
        tau = controller.command(reference, quantise(plant.theta(), options.quantum_theta));
      }
      if (sub == 0) {
        record_log(plant, options, experiment, static_cast<double>(sample) / options.rate,
                   tau + options.noise_tau * noise.normal(), reference, &log);
        record_truth(plant, tau, experiment.disturbance.at(0.0), reference, truth);
      }
      const double fraction = (sub + 0.5) / clock.steps_per_sample;
      plant.step(tau, experiment.load + experiment.disturbance.at(fraction), clock.h);
    }
    experiment.disturbance.advance();
  }
  return log;
}

// Sweep position in [-1, 1]: a sine whose speed varies, moving or stepping from level to level.
double sweep(const BlockedOptions& o, double start_phase, double t) {
  constexpr double kLevels = 16.0;
  constexpr double kMoveShare = 0.4;
  const double omega = kTwoPi / (2.7 * o.period);  // of the speed variation
  const double lead = o.speed_depth / (omega * o.period) *
                      (std::cos(start_phase) - std::cos(omega * t + start_phase));
  double cycles = t / o.period + lead;
  if (o.plateaus) {
    const double level = std::floor(cycles * kLevels);
    cycles = (level + smooth_step((cycles * kLevels - level) / kMoveShare)) / kLevels;
  }
  return std::sin(kTwoPi * cycles);
}

// Appends the value rounded to `decimals`, without trailing zeros or a negative zero.
void append_number(double value, int decimals, std::string* text) {
  std::array<char, 64> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                    std::chars_format::fixed, decimals);
  if (result.ec != std::errc()) throw std::runtime_error("number does not fit a CSV cell");
  char* end = result.ptr;
  if (decimals > 0) {
    while (end[-1] == '0') --end;
    if (end[-1] == '.') --end;
  }
  const std::string_view cell(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  text->append(cell == "-0" ? std::string_view("0") : cell);
}

}  // namespace

double Cable::torque(double l) const {
  if (l <= 0.0) return 0.0;
  double sum = 0.0;
  for (auto c = stiffness.rbegin(); c != stiffness.rend(); ++c) sum = sum * l + *c;
  return sum * l;
}

double elongation_for(const Cable& cable, double torque) {
  return bisect([&](double l) { return cable.torque(l) - torque; }, 0.0, 1.0);
}

Rig Rig::low() {
  Rig rig;
  rig.cable_1 = {{1367.7, 37844.1}, 0.0};
  rig.cable_2 = {{1575.3, 29357.2}, 0.0};
  return rig;
}

Rig Rig::high() {
  Rig rig = low();
  rig.J_link = 0.328;
  rig.J_motor = 0.014;
  rig.f_v = 9.817;
  rig.f_s = 7.034;
  rig.f_vm = 0.997;
  rig.f_sm = 3.591;
  rig.offset = 0.0186;
  rig.cable_1.initial_elongation = 5.12e-3;
  // The preload alone must be in equilibrium.
  rig.cable_2.initial_elongation =
      elongation_for(rig.cable_2, rig.cable_1.torque(rig.cable_1.initial_elongation));
  return rig;
}

double Rig::tau_elas(double phi) const {
  return cable_1.torque(phi + cable_1.initial_elongation) -
         cable_2.torque(-phi + cable_2.initial_elongation);
}

bool Rig::in_closure(double phi) const {
  return phi + cable_1.initial_elongation > 0.0 && -phi + cable_2.initial_elongation > 0.0;
}

double Rig::deflection_for(double torque) const {
  if (torque < tau_elas(-1.0) || torque > tau_elas(1.0)) {
    throw std::invalid_argument("torque out of the reach of the cables");
  }
  return bisect([&](double phi) { return tau_elas(phi) - torque; }, -1.0, 1.0);
}

BlockedOptions::BlockedOptions() {
  duration = 40.0;
  rate = 500.0;
  kp = 2000.0;
  kd = 3.0;
}

Log simulate_moving(const Rig& rig, const MovingOptions& options, Truth* truth) {
  Random random = stream(options.seed, kReferenceStream);
  std::vector<Line> lines = slow_lines(options.slow_peak, options.duration, &random);
  const std::vector<Line> fast = fast_lines(options.fast_accel, &random);
  lines.insert(lines.end(), fast.begin(), fast.end());
  // At rest the elastic torque carries the load, and the controller needs an error to carry both.
  const double theta_start = rig.deflection_for(-options.load);
  const double reference_start = theta_start + (rig.offset - options.load) / options.kp;
  Experiment experiment{
      false, options.load, theta_start,
      Disturbance(options.disturbance_sd, options.disturbance_time, 1.0 / options.rate,
                  options.seed),
      [=](double t) { return reference_start + smooth_step(t / kRampTime) * sum_of(lines, t); }};
  return run(rig, options, std::move(experiment), truth);
}

Log simulate_blocked(const Rig& rig, const BlockedOptions& options, Truth* truth) {
  Random random = stream(options.seed, kReferenceStream);
  const double start_phase = kTwoPi * random.uniform();
  const auto reference = [&](double t) {
    const double target =
        options.range * smooth_step(t / kRampTime) * sweep(options, start_phase, t);
    return target + (rig.tau_elas(target) + rig.offset) / options.kp;
  };
  Experiment experiment{true, 0.0, 0.0, Disturbance(0.0, 1.0, 1.0, options.seed), reference};
  return run(rig, options, std::move(experiment), truth);
}

void write_csv(const std::string& path, const Log& log) {
  struct Column {
    const char* name;
    const std::vector<double>* values;
    int decimals;
  };
  std::vector<Column> columns{{"t", &log.t, 9},
                              {"q", &log.q, 6},
                              {"theta", &log.theta, 6},
                              {"tau", &log.tau, 3},
                              {"tau_load", &log.tau_load, 3},
                              {"theta_ref", &log.theta_ref, 6}};
  std::erase_if(columns, [](const Column& c) { return c.values->empty(); });
  std::string text;
  for (const Column& c : columns) {
    text += c.name;
    text += &c == &columns.back() ? '\n' : ',';
  }
  for (std::size_t i = 0; i < log.t.size(); ++i) {
    for (const Column& c : columns) {
      append_number(c.values->at(i), c.decimals, &text);
      text += &c == &columns.back() ? '\n' : ',';
    }
  }
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace truth
