#include "varied_rig.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "random.hpp"
#include "step.hpp"

namespace hidden {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kDrive = 1000;        // Hz, of the controller
constexpr double kStep = 1.0 / 40000;  // s
constexpr double kColourTime = 0.2;    // s
constexpr int kSteps = 40;             // of a period of the controller
enum class Manner { sweep, slow, shaken, strokes };

/// All torques and angles follow from these, so that a rig is small or large as a whole.
struct VariedRig {
  double torque;      ///< N m, of work
  double deflection;  ///< rad, at that torque
  double J_link, J_motor, f_v, f_s, f_vm, f_sm, offset;
  std::array<double, 2> k0, k1;  ///< of (30)
  double kp, kd;
  double speed;  ///< rad/s, about the largest
  double quantum_q, quantum_theta, white, coloured;
  double rate, blocked_rate;  ///< Hz, of the logs
  bool is_mean;               ///< the log's torque: the mean over a row, else the command

  double elastic(double phi) const {
    return phi > 0 ? k0[0] * phi + k1[0] * phi * phi : k0[1] * phi - k1[1] * phi * phi;
  }
};

double log_uniform(Random& random, double lo, double hi) {
  return lo * std::pow(hi / lo, random.uniform(0, 1));
}

template <std::size_t n>
double one_of(Random& random, const std::array<double, n>& all) {
  return all[static_cast<std::size_t>(random.uniform(0, static_cast<double>(n)))];
}

VariedRig draw_rig(std::uint64_t seed) {
  Random random(seed, "varied rig");
  VariedRig r{};
  r.torque = log_uniform(random, 0.02, 200);
  r.deflection = log_uniform(random, 4e-3, 60e-3);
  const double resonance = kTwoPi * log_uniform(random, 12, 60);
  const double ratio = log_uniform(random, 3, 40), k = r.torque / r.deflection;
  r.J_motor = k / (resonance * resonance) * (1 + ratio) / ratio;
  r.J_link = ratio * r.J_motor;
  const double curvature = random.uniform(0, 0.6);
  for (std::size_t c : {0, 1}) {
    r.k0[c] = k * (1 - curvature) * random.uniform(0.9, 1.1);
    r.k1[c] = k * curvature / r.deflection * random.uniform(0.8, 1.2);
  }
  r.speed = log_uniform(random, 0.5, 6);
  r.f_s = r.torque * random.uniform(0.01, 0.1);
  r.f_sm = r.torque * random.uniform(0.01, 0.08);
  r.f_v = r.torque * random.uniform(0.02, 0.1) / r.speed;
  r.f_vm = r.torque * random.uniform(0.01, 0.05) / r.speed;
  r.offset = r.torque * random.uniform(-0.01, 0.01);
  r.white = r.torque * log_uniform(random, 1e-3, 1e-2);
  r.coloured = random.uniform(0, 1) < 0.5 ? 0 : r.torque * log_uniform(random, 3e-4, 2e-3);
  r.quantum_q = r.deflection / log_uniform(random, 60, 3000);
  r.quantum_theta = r.deflection / log_uniform(random, 60, 3000);
  r.rate = one_of<4>(random, {250, 500, 1000, 2000});
  r.blocked_rate = one_of<4>(random, {100, 250, 500, 1000});
  r.is_mean = random.uniform(0, 1) < 0.5;
  const double bandwidth = random.uniform(0.25, 0.8) * resonance, all = r.J_link + r.J_motor;
  r.kd = std::min(1.4 * all * bandwidth * random.uniform(0.5, 1.2), 0.5 * r.J_motor * kDrive);
  r.kp = std::min(all * bandwidth * bandwidth * random.uniform(0.5, 1.5), r.kd * bandwidth);
  return r;
}

/// theta_ref over time.
class Motion {
 public:
  Motion(const VariedRig& rig, Manner manner, Random& random) : rig_(rig), manner_(manner) {
    for (double& phase : phases_) phase = random.uniform(0, kTwoPi);
    period_ = manner == Manner::sweep ? random.uniform(6, 20) : random.uniform(4, 8);
    size_ = rig.deflection * random.uniform(0.8, 1.3);
  }

  double operator()(double t) const {
    const double fade = t < 1 ? t * t * (3 - 2 * t) : 1;
    if (manner_ != Manner::sweep) return fade * (way() * shape(t) + dither(t));
    const double depth = 0.7 + 0.3 * std::cos(kTwoPi * t / (2.7 * period_));
    const double phi = size_ * depth * std::sin(kTwoPi * t / period_);
    return fade * (phi + rig_.elastic(phi) / rig_.kp);
  }

 private:
  double way() const { return rig_.speed / (kTwoPi * 0.4); }

  double sum(double t, int n, double spacing, double fall) const {
    double x = 0;
    for (int i = 0; i < n; ++i)
      x += std::sin(kTwoPi * spacing * (i + 1) * t + phases_[static_cast<std::size_t>(i)]) /
           (1 + fall * i);
    return x;
  }

  double shape(double t) const {
    if (manner_ == Manner::slow) return 0.5 * sum(t, 9, 0.05, 0.5);
    if (manner_ == Manner::shaken) return 0.3 * sum(t, 12, 0.15, 0.3);
    const double x = 2 * std::fmod(t, period_) / period_, y = x < 1 ? x : 2 - x;
    const double s = y < 0.1 ? 0 : y > 0.9 ? 1 : (y - 0.1) / 0.8;  // with a rest at either end
    return 1.2 * (s * s * (3 - 2 * s) - 0.5) * (0.6 + 0.4 * std::sin(kTwoPi * 0.03 * t));
  }

  /// 4 to 23 Hz, each with 6 % of the torque of work.
  double dither(double t) const {
    if (manner_ != Manner::shaken) return 0;
    double x = 0;
    for (int i = 0; i < 10; ++i) {
      const double omega = kTwoPi * (4 + 2.1 * i), k = rig_.torque / rig_.deflection;
      x += 0.06 * rig_.torque / (rig_.J_motor * omega * omega + k) *
           std::sin(omega * t + phases_[static_cast<std::size_t>(12 + i)]);
    }
    return x;
  }

  const VariedRig& rig_;
  Manner manner_;
  std::array<double, 22> phases_{};
  double period_ = 1, size_ = 0;
};

struct LoggedRow {
  double t, q, theta, tau;
};

std::vector<LoggedRow> record(const VariedRig& rig, Manner manner, double seconds, double load,
                              std::uint64_t seed) {
  Random random(seed, "varied log");
  const bool is_blocked = manner == Manner::sweep;
  const Motion reference(rig, manner, random);
  const auto every = std::lround(1 / ((is_blocked ? rig.blocked_rate : rig.rate) * kStep));
  const auto rounded = [](double x, double quantum) { return quantum * std::round(x / quantum); };
  std::vector<LoggedRow> rows;
  double q = 0, qd = 0, theta = 0, thetad = 0, tau = 0, seen = 0, sum = 0, colour = 0;
  const double kept = std::exp(-static_cast<double>(every) * kStep / kColourTime);
  const long n = std::lround(seconds / kStep);
  for (long i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) * kStep;
    if (i % kSteps == 0) {
      const double now = rounded(theta, rig.quantum_theta);
      const double slope = (reference(t + 1e-4) - reference(t - 1e-4)) / 2e-4;
      tau = rig.kp * (reference(t) - now) + rig.kd * (slope - (now - seen) * kDrive);
      seen = now;
    }
    if (i % every == 0)
      rows.push_back({t, rounded(q, rig.quantum_q), rounded(theta, rig.quantum_theta), tau});
    sum += tau;
    if (i % every == every / 2 - 1) {  // half of the row's mean is from before it
      if (rig.is_mean) rows.back().tau = sum / static_cast<double>(i < every ? every / 2 : every);
      sum = 0;
    }
    const double elastic = rig.elastic(theta - q + 0.5 * kStep * (thetad - qd));
    const Slide motor =
        slide(thetad, rig.J_motor, rig.f_vm, tau - elastic - rig.offset, rig.f_sm, rig.f_sm, kStep);
    thetad = motor.v, theta += motor.dx;
    if (is_blocked) continue;
    const Slide link = slide(qd, rig.J_link, rig.f_v, elastic + load, rig.f_s, rig.f_s, kStep);
    qd = link.v, q += link.dx;
  }
  for (LoggedRow& row : rows) {
    colour = kept * colour + rig.coloured * std::sqrt(1 - kept * kept) * random.normal();
    row.tau += colour + rig.white * random.normal();
  }
  return rows;
}

void write_log(const std::filesystem::path& file, const std::vector<LoggedRow>& rows, double load) {
  std::ofstream out(file);
  out << "t,q,theta,tau,tau_load\n";
  for (const LoggedRow& row : rows)
    out << fmt::format("{:.5f},{:.10g},{:.10g},{:.8g},{:.8g}\n", row.t, row.q, row.theta, row.tau,
                       load);
}

}  // namespace

void write_varied_rig(const std::filesystem::path& folder, std::uint64_t seed) {
  std::filesystem::create_directories(folder);
  const VariedRig rig = draw_rig(seed);
  Random random(seed, "varied bench");
  const auto load = [&](double lo, double hi) { return rig.torque * random.uniform(lo, hi); };
  const auto usual = static_cast<Manner>(1 + static_cast<int>(random.uniform(0, 3)));
  const struct {
    const char* name;
    Manner manner;
    double seconds, load;
  } logs[] = {{"blocked.csv", Manner::sweep, 40, 0},
              {"up.csv", usual, 25, load(0.3, 0.6)},
              {"down.csv", Manner::shaken, 25, -load(0.3, 0.6)},
              {"free.csv", Manner::slow, 20, 0},
              {"test.csv", usual, 20, load(-0.5, 0.5)}};
  std::uint64_t number = 0;
  for (const auto& log : logs)
    write_log(folder / log.name,
              record(rig, log.manner, log.seconds, log.load, 8 * seed + number++), log.load);
  std::ofstream(folder / "rig.json") << R"({"schema": "cablefit/rig/1"})" << '\n';
  const nlohmann::ordered_json truth{{"schema", "hidden/truth/1"},
                                     {"effects", nlohmann::json::array()},
                                     {"clutter", 0},
                                     {"expected", "none"},
                                     {"logs",
                                      {{"blocked", {"blocked.csv"}},
                                       {"train", {"up.csv", "down.csv", "free.csv"}},
                                       {"test", {"test.csv"}}}},
                                     {"rate", rig.rate},
                                     {"torque", rig.torque},
                                     {"is_mean", rig.is_mean},
                                     {"base",
                                      {{"J_link", rig.J_link},
                                       {"J_motor", rig.J_motor},
                                       {"f_v", rig.f_v},
                                       {"f_s", rig.f_s},
                                       {"f_vm", rig.f_vm},
                                       {"f_sm", rig.f_sm},
                                       {"offset", rig.offset},
                                       {"K1_0", rig.k0[0]},
                                       {"K1_1", rig.k1[0]},
                                       {"K2_0", rig.k0[1]},
                                       {"K2_1", rig.k1[1]}}}};
  std::ofstream(folder / "truth.json") << truth.dump(1) << '\n';
}

}  // namespace hidden
