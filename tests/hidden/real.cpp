#include "real.hpp"

#include <Eigen/QR>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "random.hpp"
#include "write.hpp"

namespace hidden {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using nlohmann::ordered_json;

constexpr double kTwoPi = 2 * std::numbers::pi;

/// sgn(v) with a rounded step: at rest the friction of a real log is somewhere in between.
ArrayXd direction(const Track& x, const RealScale& scale) {
  return x.v.array() / (x.v.array().square() + std::pow(0.02 * scale.speed, 2)).sqrt();
}

VectorXd stribeck(const Track& x, const RealScale& scale, double u, double) {
  const double v_s = (0.2 + 0.3 * u) * scale.speed;
  return direction(x, scale) * (-(x.v.array() / v_s).square()).exp();
}
VectorXd quadratic_drag(const Track& x, const RealScale& scale, double, double) {
  return x.v.array() * x.v.array().abs() / (scale.speed * scale.speed);
}
VectorXd asymmetric_viscous(const Track& x, const RealScale& scale, double, double) {
  return x.v.array().abs() / scale.speed;
}
VectorXd cogging(const Track& x, const RealScale& scale, double u, double w) {
  return (kTwoPi * ((4 + 6 * u) * x.x.array() / scale.range + w)).sin();
}
VectorXd position_friction(const Track& x, const RealScale& scale, double u, double w) {
  return direction(x, scale) * (kTwoPi * ((0.4 + 0.4 * u) * x.x.array() / scale.range + w)).sin();
}
VectorXd hysteresis(const Track& x, const RealScale& scale, double u, double) {
  const double y = (0.1 + 0.2 * u) * scale.range;
  VectorXd out = VectorXd::Zero(x.x.size());
  for (Index k = 1; k < out.size(); ++k) {
    // What an encoder's noise adds up to while a real axis rests is no way.
    const bool rests = std::abs(x.v[k]) < 0.1 * scale.speed;
    const double way = rests ? 0 : x.x[k] - x.x[k - 1];
    const auto toward = static_cast<double>((way > 0) - (way < 0));
    out[k] = toward + (out[k - 1] - toward) * std::exp(-std::abs(way) / y);
  }
  return out;
}

/// What the log's base model explains torque by: rigid drive, or spring with friction.
MatrixXd base_columns(const RealSet& set, const Track& x, const RealScale& scale) {
  const ArrayXd sign = direction(x, scale), one = ArrayXd::Ones(x.x.size());
  MatrixXd W(x.x.size(), set.blocked ? 6 : 4);
  if (!set.blocked) {
    W << x.a, x.v, sign, one;
    return W;
  }
  const ArrayXd phi = x.x.array() - x.x.mean();
  W << phi.max(0), phi.max(0).square(), phi.min(0), phi.min(0).square(), sign, one;
  return W;
}

VectorXd leftover(MatrixXd W, const VectorXd& y) {
  const VectorXd scale = W.colwise().norm().transpose();
  W *= scale.cwiseInverse().asDiagonal();
  return y - W * W.householderQr().solve(y);
}

double rms(const VectorXd& x) { return x.norm() / std::sqrt(static_cast<double>(x.size())); }

template <typename Row>
const Row& find(const std::vector<Row>& rows, const std::string& name, const char* what) {
  std::string known;
  for (const Row& row : rows) {
    if (row.name == name) return row;
    known += ' ' + std::string(row.name);
  }
  throw std::invalid_argument(std::string("no ") + what + " '" + name + "'; there are:" + known);
}

struct Log {
  std::string file, role;
  RealLog log;
  Track motion;
};

std::vector<Log> read(const std::filesystem::path& data, const RealSet& set) {
  std::vector<Log> logs;
  for (const auto& [files, role] :
       {std::pair{&set.train, set.blocked ? "blocked" : "train"}, std::pair{&set.test, "test"}})
    for (const std::string_view file : *files) {
      Log one{std::string(file), role, read_log(data / set.folder / file), {}};
      one.motion = track(one.log.column("t"), one.log.column("theta"), set.half_window);
      logs.push_back(std::move(one));
    }
  return logs;
}

RealScale scale_of(const std::vector<Log>& logs) {
  RealScale scale{0, 0};
  double n = 0;
  for (const Log& one : logs) {
    if (one.role == "test") continue;
    const auto& x = one.motion.x.array();
    scale.range = std::max(scale.range, (x - x.mean()).abs().maxCoeff());
    scale.speed += one.motion.v.squaredNorm();
    n += static_cast<double>(x.size());
  }
  scale.speed = std::sqrt(scale.speed / n);
  return scale;
}

/// What remains to be explained: tau, with the known load on its side.
VectorXd right_side(const RealLog& log) {
  return log.has("tau_load") ? VectorXd(log.column("tau") + log.column("tau_load"))
                             : log.column("tau");
}

struct Size {
  double gap = 0, torque = 0, unabsorbed = 0;  ///< rms over the training logs
};

/// Of the untouched logs, and of the effect at size 1.
Size size_of(const RealSet& set, const std::vector<Log>& logs, const RealScale& scale,
             const std::vector<VectorXd>& torque) {
  Index n = 0;
  for (const Log& one : logs) n += one.role == "test" ? 0 : one.motion.x.size();
  MatrixXd W(n, set.blocked ? 6 : 4);
  VectorXd y(n), planted(n);
  Index at = 0;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (logs[i].role == "test") continue;
    const Index rows = logs[i].motion.x.size();
    W.middleRows(at, rows) = base_columns(set, logs[i].motion, scale);
    y.segment(at, rows) = right_side(logs[i].log);
    planted.segment(at, rows) = torque[i];
    at += rows;
  }
  return {rms(leftover(W, y)), rms(planted), rms(leftover(W, planted))};
}

ordered_json truth_json(const RealSpec& spec, const RealEffect& effect,
                        const std::vector<Log>& logs, const Size& size, double amplitude) {
  ordered_json truth{
      {"schema", "hidden/truth/1"},
      {"design", "real"},
      {"set", spec.set},
      {"seed", spec.seed},
      {"clutter", 0},
      {"expected", "named"},
      {"ratio", spec.ratio},
      {"ratio_unabsorbed", size.unabsorbed * amplitude / size.gap},
      {"gap_before_planting", size.gap},
      {"effects",
       {{{"id", std::string(effect.name) + '.' + std::string(effect.side)},
         {"name", effect.name},
         {"side", effect.side},
         {"alias_class", ""},
         {"form", "matched"},
         {"in_base", false},
         {"coefficients", {{{"name", "amplitude"}, {"value", amplitude}, {"unit", "of tau"}}}}}}},
      {"logs",
       {{"train", ordered_json::array()},
        {"test", ordered_json::array()},
        {"blocked", ordered_json::array()}}}};
  for (const Log& one : logs) truth["logs"][one.role].push_back(one.file);
  return truth;
}

}  // namespace

const std::vector<RealSet>& real_sets() {
  static const std::vector<RealSet> rows{
      {"emps",
       "emps",
       {"emps_ident.csv"},
       {},
       false,
       15,
       R"({"schema": "cablefit/rig/1", "name": "EMPS", "motion": "linear"})"},
      {"sea",
       "sea_imperial_blocked",
       {"spring2_amp2_id16.csv", "spring2_amp3_id20.csv"},
       {"spring2_amp1_id13.csv"},
       true,
       10,
       R"({"schema": "cablefit/rig/1", "name": "series elastic actuator, spring 2"})"},
      {"xl330",
       "bam_xl330",
       {"xl330_kp100_sin_sin.csv", "xl330_kp400_sin_sin.csv", "xl330_kp100_up_and_down.csv"},
       {"xl330_kp100_sin_time_square.csv", "xl330_kp400_sin_time_square.csv"},
       false,
       5,
       R"({"schema": "cablefit/rig/1", "name": "XL330 with pendulum", "load": {"type": "column"}})"},
  };
  return rows;
}

const std::vector<RealEffect>& real_effects() {
  static const std::vector<RealEffect> rows{
      {"stribeck", "motor", true, false, stribeck},
      {"quadratic_drag", "motor", true, false, quadratic_drag},
      {"asymmetric_viscous", "motor", true, false, asymmetric_viscous},
      {"cogging", "motor", true, true, cogging},
      {"position_friction", "motor", true, false, position_friction},
      {"cable_hysteresis", "transmission", false, true, hysteresis},
  };
  return rows;
}

void plant_real(const std::filesystem::path& data, const RealSpec& spec,
                const std::filesystem::path& folder) {
  const RealSet& set = find(real_sets(), spec.set, "set of real logs");
  const RealEffect& effect = find(real_effects(), spec.effect, "effect for real logs");
  if (!(set.blocked ? effect.blocked : effect.moving))
    throw std::invalid_argument(spec.effect + " cannot be seen in " + spec.set);
  const std::vector<Log> logs = read(data, set);
  const RealScale scale = scale_of(logs);
  Random random(spec.seed, spec.set + spec.effect);
  const double u = random.uniform(0, 1), w = random.uniform(0, 1);
  std::vector<VectorXd> torque;
  for (const Log& one : logs) torque.push_back(effect.torque(one.motion, scale, u, w));

  const Size size = size_of(set, logs, scale, torque);
  const double amplitude = spec.ratio * size.gap / size.torque;
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < logs.size(); ++i)
    write_text(folder / logs[i].file,
               logs[i].log.with_tau(logs[i].log.column("tau") + amplitude * torque[i]));
  write_text(folder / "rig.json", std::string(set.rig) + '\n');
  write_text(folder / "truth.json", truth_json(spec, effect, logs, size, amplitude).dump(2) + '\n');
}

}  // namespace hidden
