#include "user_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "random.hpp"
#include "simulate.hpp"
#include "write.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kPeriod = 1 / kRate;
constexpr double kReach = 0.77;           // rad, of the moving reference
constexpr double kHighElongation = 0.06;  // rad
constexpr double kBlockedSeconds = 40;
constexpr double kSlowNoise = 0.2;  // s

Rig rig_of(const UserSpec& spec) {
  Random random(spec.seed, spec.preload);
  const bool high = spec.preload == "high";
  if (!high && spec.preload != "low") throw std::invalid_argument("preload is low or high");
  Rig rig;
  if (high) {
    rig.J_link = 0.328, rig.J_motor = 0.014, rig.f_v = 9.817, rig.f_s = 7.034;
    rig.f_vm = 0.997, rig.f_sm = 3.591, rig.offset = 0.0186;
    rig.cable_1.c[1] = 3891.4, rig.cable_2.c = {1367.7, 3094.9};
  }
  for (double* value : {&rig.J_link, &rig.J_motor, &rig.f_v, &rig.f_s, &rig.f_vm, &rig.f_sm})
    *value *= 1 + 0.1 * random.uniform(-1, 1);
  for (double* value : {&rig.cable_1.c[0], &rig.cable_1.c[1], &rig.cable_2.c[0], &rig.cable_2.c[1]})
    *value *= 1 + 0.05 * random.uniform(-1, 1);
  if (high) return preloaded(rig, kHighElongation);
  return spec.l_o > 0 ? preloaded(rig, spec.l_o) : rig;
}

UserTruth truth_of(const Rig& rig) {
  UserTruth truth{rig};
  const double h = 1e-6;
  const auto bend = [&](double side) {
    const double one = rig.tau_elas(side * h), two = rig.tau_elas(2 * side * h);
    return side * (two - 2 * one) / (2 * h * h);
  };
  truth.K1_0 = truth.K2_0 = rig.stiffness(0);
  truth.K1_1 = bend(1);
  truth.K2_1 = bend(-1);
  if (rig.cable_1.l_o < kHighElongation) {  // a kink shows where a cable goes slack: l_o is found
    truth.K1_0 = rig.cable_1.c[0], truth.K2_0 = rig.cable_2.c[0];
    truth.K1_1 = rig.cable_1.c[1], truth.K2_1 = rig.cable_2.c[1];
  }
  return truth;
}

/// A reference that grows piece by piece, each beginning where the one before ended.
class Motion {
 public:
  Motion(Random& random, std::size_t n) : random_(random), n_(n) { hold(0.6); }

  bool full() const { return path_.size() >= n_; }
  Reference path() const { return {path_.begin(), path_.begin() + static_cast<long>(n_)}; }

  /// From pose to pose at speeds of 0.01 to 2 rad/s, with rests between.
  void ladder(double seconds) {
    const std::size_t end = path_.size() + count(seconds);
    while (path_.size() < end) {
      go(random_.uniform(-kReach, kReach), std::exp(random_.uniform(std::log(0.01), std::log(2))),
         2.5);
      hold(random_.uniform(0.05, 0.8));
    }
  }
  void multisine(double seconds, double lowest, double highest, double fall, double peak) {
    const double centre = random_.uniform(-0.1, 0.1);
    go(centre, 0.5, 5);
    hold(0.3);
    std::vector<double> piece(count(seconds), 0.0);
    for (double f = lowest; f <= highest; f += 1 / seconds) {
      const double phase = random_.uniform(0, kTwoPi), amplitude = std::pow(f, -fall);
      for (std::size_t k = 0; k < piece.size(); ++k)
        piece[k] += amplitude * std::sin(kTwoPi * f * kPeriod * static_cast<double>(k) + phase);
    }
    double largest = 0;
    for (const double x : piece) largest = std::max(largest, std::abs(x));
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const double t = kPeriod * static_cast<double>(k);
      const double fade = smooth(t / 0.5) * smooth((seconds - t) / 0.5);
      path_.push_back(centre + fade * peak / largest * piece[k]);
    }
  }

 private:
  static std::size_t count(double seconds) {
    return static_cast<std::size_t>(std::lround(seconds * kRate));
  }
  static double smooth(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x * x * x * (10 + x * (6 * x - 15));
  }
  void hold(double seconds) { path_.insert(path_.end(), count(seconds), last()); }
  double last() const { return path_.empty() ? 0 : path_.back(); }

  /// There at a speed that sets in within a tenth of a second; no longer than `most` seconds.
  void go(double to, double speed, double most) {
    const double from = last(), way = to - from;
    const double ramp = 0.1;
    const double seconds = std::clamp(std::abs(way) / speed + ramp, 0.25, most);
    const double moved = std::min(std::abs(way), speed * (seconds - ramp));
    const double reached = std::copysign(moved, way), v = reached / (seconds - ramp);
    const std::size_t n = count(seconds);
    for (std::size_t k = 0; k < n; ++k) {
      const double t = kPeriod * static_cast<double>(k);
      const double into = std::min(t, ramp), out = std::max(0.0, t - (seconds - ramp));
      path_.push_back(
          from + v * (into * into / (2 * ramp) + std::max(0.0, t - ramp) - out * out / (2 * ramp)));
    }
  }

  Random& random_;
  std::size_t n_;
  Reference path_;
};

Reference moving_reference(const UserSpec& spec) {
  Random random(spec.seed, "motion");
  Motion motion(random, static_cast<std::size_t>(std::lround(spec.seconds * kRate)));
  const double part = std::max(1.0, spec.seconds / 6);
  while (!motion.full()) {
    const double which = random.uniform(0, 4);
    motion.ladder(part);
    if (which < 2) motion.multisine(part, 0.15, 1, 0.7, 0.75);
    motion.multisine(1.5 * part, 2.5, random.uniform(5, 9), 1.2, 0.1);
    if (which >= 2) motion.multisine(part, 0.15, 1, 0.7, 0.75);
    motion.multisine(0.8 * part, 0.15, 0.5, 1, 0.2);
  }
  return motion.path();
}

/// Slow triangles of +-50 mrad with a little of 1 Hz on top.
Reference blocked_reference(const Rig& rig, double kp) {
  Reference out(static_cast<std::size_t>(kBlockedSeconds * kRate));
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double t = kPeriod * static_cast<double>(k) - 0.6;
    const double x = std::max(0.0, t) / 26;
    const double triangle = 1 - 4 * std::abs(x + 0.25 - std::floor(x + 0.25) - 0.5);
    const double phi = 0.049 * triangle + (t > 0 ? 0.00075 * std::sin(kTwoPi * 1.03 * t) : 0);
    out[k] = phi + rig.tau_elas(phi) / kp;
  }
  return out;
}

/// tau[k] is held from sample k on: its mean over `seconds` centred on each sample.
std::vector<double> mean_of_held(const std::vector<double>& tau, double seconds) {
  std::vector<double> sum(tau.size() + 1, 0.0);  // integral until sample k, in samples
  for (std::size_t k = 0; k < tau.size(); ++k) sum[k + 1] = sum[k] + tau[k];
  const double n = static_cast<double>(tau.size()), half = 0.5 * seconds * kRate;
  const auto integral = [&](double at) {
    at = std::clamp(at, 0.0, n);
    const auto k = std::min(tau.size() - 1, static_cast<std::size_t>(at));
    return sum[k] + (at - static_cast<double>(k)) * tau[k];
  };
  std::vector<double> mean(tau.size());
  for (std::size_t k = 0; k < tau.size(); ++k) {
    const double at = static_cast<double>(k);
    const double from = std::max(0.0, at - half), to = std::min(n, at + half);
    mean[k] = (integral(to) - integral(from)) / (to - from);
  }
  return mean;
}

struct Sampling {
  std::size_t every = 1;  ///< of the rows at 1 kHz
  double lost = 0, stamp_jitter = 0, sample_jitter = 0;
  double torque_mean = 1e-3;
};

void write_rows(const std::filesystem::path& file, const UserSpec& spec, const Sampling& sampling,
                const Recording& recording, double pendulum) {
  const Signals& exact = recording.exact;
  const std::vector<double> tau = mean_of_held(exact.tau, sampling.torque_mean);
  Random white(spec.seed, file.filename().string() + " white");
  Random slow(spec.seed, file.filename().string() + " slow");
  Random clock(spec.seed, file.filename().string() + " clock");
  double colour = spec.coloured * slow.normal();
  const double keeps = std::exp(-kPeriod / kSlowNoise);
  const bool with_reference = spec.controller && !exact.blocked;
  std::string text =
      with_reference ? "t,q,theta,tau,tau_load,theta_ref\n" : "t,q,theta,tau,tau_load\n";
  const auto counts = [](double x, double quantum) {
    return quantum > 0 ? quantum * std::round(x / quantum) : x;
  };
  for (std::size_t k = 0; k < exact.q.size(); ++k) {
    colour = keeps * colour + std::sqrt(1 - keeps * keeps) * spec.coloured * slow.normal();
    const double noise = spec.white * white.normal();
    if (k % sampling.every != 0) continue;
    const double shift = sampling.sample_jitter * clock.normal();
    const double stamp = sampling.stamp_jitter * clock.normal();
    const bool is_lost = clock.uniform(0, 1) < sampling.lost;
    if (is_lost && k > 0) continue;
    const std::size_t next = std::min(k + 1, exact.q.size() - 1), before = k > 0 ? k - 1 : 0;
    const double speed = kRate / static_cast<double>(next - before);
    const double q = exact.q[k] + shift * speed * (exact.q[next] - exact.q[before]);
    const double theta = exact.theta[k] + shift * speed * (exact.theta[next] - exact.theta[before]);
    const double t = kPeriod * static_cast<double>(k);
    text += fmt::format("{:.{}f},{:.8f},{:.8f},{:.3f},{:.3f}", t + shift + stamp,
                        shift + stamp != 0 ? 7 : 3, counts(q, spec.quantum_q),
                        counts(theta, spec.quantum_theta), tau[k] + colour + noise,
                        exact.blocked ? 0 : -pendulum * std::sin(q));
    text += with_reference ? fmt::format(",{:.8f}\n", exact.theta_ref[k]) : "\n";
  }
  write_text(file, text);
}

void write_truth(const std::filesystem::path& file, const UserTruth& truth) {
  const Rig& r = truth.rig;
  const nlohmann::ordered_json json{
      {"J_link", r.J_link}, {"J_motor", r.J_motor}, {"f_v", r.f_v},       {"f_s", r.f_s},
      {"f_vm", r.f_vm},     {"f_sm", r.f_sm},       {"offset", r.offset}, {"K1_0", truth.K1_0},
      {"K1_1", truth.K1_1}, {"K2_0", truth.K2_0},   {"K2_1", truth.K2_1}};
  write_text(file, json.dump(1) + '\n');
}

void write_rig(const std::filesystem::path& file, const UserSpec& spec, const Bench& bench) {
  nlohmann::ordered_json json{{"schema", "cablefit/rig/1"},
                              {"preload", spec.preload},
                              {"torque_hold", "none"},
                              {"load", {{"type", "column"}}},
                              {"sensors",
                               {{"q", {{"quantum", spec.quantum_q}}},
                                {"theta", {{"quantum", spec.quantum_theta}}},
                                {"tau", {{"noise", std::hypot(spec.white, spec.coloured)}}}}}};
  if (spec.controller)
    json["controller"] = {{"type", "pd"},         {"kp", bench.kp},    {"kd", bench.kd},
                          {"limit", bench.limit}, {"period", kPeriod}, {"reference", "theta_ref"}};
  write_text(file, json.dump(1) + '\n');
}

}  // namespace

void write_user_rig(const std::filesystem::path& folder, const UserSpec& spec) {
  Bench bench;
  bench.rig = rig_of(spec);
  bench.quantum_q = spec.quantum_q;
  bench.quantum_theta = spec.quantum_theta;
  Random random(spec.seed, "bench");
  bench.kp = random.uniform(300, 700);
  bench.kd = random.uniform(5, 9);
  const double pendulum = random.uniform(12, 14);

  Hooks swing;
  swing.sides = [pendulum](const State& s, Sides& sides) {
    sides.link.torque += pendulum * std::sin(s.q);
  };
  Run moving;
  moving.name = "moving";
  moving.reference = moving_reference(spec);
  Run blocked;
  blocked.name = "blocked";
  blocked.blocked = true;
  blocked.reference = blocked_reference(bench.rig, bench.kp);

  std::filesystem::create_directories(folder);
  Sampling sampling;
  sampling.every = static_cast<std::size_t>(std::lround(kRate / spec.rate));
  sampling.torque_mean = spec.torque_mean;
  write_rows(folder / "blocked.csv", spec, {2 * sampling.every, 0, 0, 0, spec.torque_mean},
             simulate(bench, {}, blocked), pendulum);
  sampling.lost = spec.lost;
  sampling.stamp_jitter = spec.stamp_jitter;
  sampling.sample_jitter = spec.sample_jitter;
  write_rows(folder / "moving.csv", spec, sampling, simulate(bench, {swing}, moving), pendulum);
  write_rig(folder / "rig.json", spec, bench);
  write_truth(folder / "truth.json", truth_of(bench.rig));
}

}  // namespace hidden
