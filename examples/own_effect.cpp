// An effect that the library does not know: a rubber cushion at both ends of the link's range. The
// row below is all it takes: refine looks for it, simulations have it, stage 2 fits it. The logs
// are simulated here, with the cushion hidden in them. usage: own_effect BENCH.json
#include <algorithm>
#include <cablefit/cablefit.hpp>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace cablefit;

constexpr double kRate = 1000;   // Hz
constexpr double kNoise = 3e-6;  // rad, of both encoders

/// Torque per unit of a, on the left side of the link's equation: it opposes.
void cushion(const JointState& state, const double* shape, const double* /*z*/, double* link,
             double* /*motor*/) {
  const double depth = std::max(0.0, std::abs(state.q) - shape[0]);
  link[0] = std::copysign(depth * depth, state.q);
}

constexpr ParameterInfo kParameters[] = {
    {"stiffening", "a", "N m", "torque at a depth of 1 rad", 0},
    {"q_0", "q_0", "rad", "where the cushion begins", 0.01}};
constexpr ShapeGrid kShape[] = {{.low = 0.2, .high = 0.8, .n_values = 7, .is_geometric = false}};

Effect end_cushion() {
  return {.name = "end_cushion",
          .site = Site::link,
          .equation = "a (|q| - q_0)^2 sgn(q) beyond |q| = q_0",
          .signature = "a torque of the link at both ends of its range, whatever the speed",
          .experiment = "slow motion to both ends",
          .source = "this example",
          .parameters = kParameters,
          .shape = kShape,
          .torque = cushion};
}

Estimate value(const char* name, double number) {
  Estimate e;
  e.name = name;
  e.value = number;
  return e;
}

/// Two sines, rad; slower and shorter for a blocked link.
Eigen::ArrayXXd reference(double seconds, double size, double hz) {
  const Eigen::ArrayXd t =
      Eigen::ArrayXd::LinSpaced(static_cast<Eigen::Index>(seconds * kRate), 0, seconds - 1 / kRate);
  const double w = 2 * 3.14159265358979 * hz;
  return size * ((w * t).sin() + 0.4 * (3.3 * w * t).sin());
}

/// What a bench would log of this model.
LogSurvey recorded(const std::string& name, const Model& model, const Eigen::ArrayXXd& theta_ref,
                   bool blocked, unsigned seed) {
  SimulationInput input;
  input.period = 1 / kRate;
  input.theta_ref = theta_ref;
  const SimulationResult motion =
      simulate(model, input, {.closed_loop = true, .link_blocked = blocked});
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, kNoise);
  std::vector<double> t, q, theta, tau;
  for (Eigen::Index i = 0; i < motion.q.rows(); ++i) {
    t.push_back(static_cast<double>(i) / kRate);
    q.push_back(motion.q(i, 0) + (blocked ? 0 : noise(random)));
    theta.push_back(motion.theta(i, 0) + noise(random));
    tau.push_back(motion.tau(i, 0) + 1e4 * noise(random));
  }
  const std::vector<double> held(theta_ref.data(), theta_ref.data() + theta_ref.size());
  const std::vector<MemoryColumn> columns = {
      {"t", t}, {"q", q}, {"theta", theta}, {"tau [N m]", tau}, {"theta_ref", held}};
  return survey_memory(name, columns, model.rig);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    add_effect(end_cushion());
    std::string choice;
    Model bench = read_model(argv[1], "", "", choice);
    bench.joints[0].added.push_back(
        {&find_candidate("end_cushion", Site::link), {value("stiffening", 40), value("q_0", 0.5)}});
    RefineLogs logs;
    logs.blocked = {recorded("blocked", bench, reference(20, 0.03, 0.1), true, 1)};
    logs.train = {recorded("fast", bench, reference(12, 0.6, 0.5), false, 2),
                  recorded("slow", bench, reference(12, 0.6, 0.2), false, 3)};
    logs.test = {recorded("test", bench, reference(12, 0.65, 0.35), false, 4)};
    RefineOptions options;
    options.n_draws = 6;
    options.threads = 2;
    const RefineResult result = missing_effects(logs, options);
    std::printf("%s: %s\n", std::string(to_string(result.verdict)).c_str(), result.reason.c_str());
    for (const NamedEffect& effect : result.effects) {
      std::printf("%s\n", std::string(effect.instance.effect->name).c_str());
      for (const Estimate& e : effect.instance.parameters)
        std::printf("  %s = %.4g +- %.2g %s\n", e.name.c_str(), e.value, e.sd, e.unit.c_str());
    }
    return result.verdict == Verdict::named &&
                   result.effects.front().instance.effect->name == "end_cushion"
               ? 0
               : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
