// Closed loops: a disturbance on the link comes back through the controller, and noise of the
// encoders stands in the regressors. Least squares is biased by both; instruments from the
// noise-free loop are not. Put the measured regressors in their place and these cases fail.
#include "tests/support/monte_carlo.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr std::uint64_t kBaseSeed = 50000;
constexpr double k16Bit = 9.6e-5;  // rad

/// Stage 1 with the true cables: what is looked for is the bias of stage 2 alone.
ElasticResult true_stage1() {
  const std::vector<LogSurvey> blocked = {shipped("low/blocked.csv")};
  ElasticResult stage1 = fit_elastic(blocked, {});
  stage1.preloads.at(0).name = "default";
  const truth::Rig rig = truth::Rig::low();
  for (ElasticFit& fit : stage1.preloads.at(0).fits) {
    if (fit.model != "poly") continue;
    fit.transmission.cables.at(0).coefficients = rig.cable_1.stiffness;
    fit.transmission.cables.at(1).coefficients = rig.cable_2.stiffness;
    fit.covariance.setZero();
  }
  return stage1;
}

struct Cell {
  double kp, kd;                 // of the loop
  std::optional<double> cutoff;  // Hz
  bool known_controller = true;  // the fit has it
};

/// 60 s in two loads, 1.5 N m of disturbance with a correlation time of 0.1 s, 16-bit encoders.
Bench one_bench(const Cell& cell, int run) {
  Bench bench;
  bench.rig.torque_hold = TorqueHold::zoh;
  if (cell.known_controller) {
    bench.rig.controller.emplace();
    bench.rig.controller->kp = cell.kp;
    bench.rig.controller->kd = cell.kd;
    bench.rig.controller->limit = truth::CommonOptions{}.limit;
  }
  std::uint64_t seed = kBaseSeed + 2 * static_cast<std::uint64_t>(run);
  for (const double load : {30.0, -40.0}) {
    truth::MovingOptions options;
    options.seed = seed++;
    options.duration = 30;
    options.load = load;
    options.kp = cell.kp;
    options.kd = cell.kd;
    options.quantum_q = options.quantum_theta = k16Bit;
    options.disturbance_sd = 1.5;
    bench.add(truth::simulate_moving(truth::Rig::low(), options));
  }
  return bench;
}

struct Comparison {
  std::vector<RunTable> wls, iv;
  std::vector<std::string> verdicts;  ///< of the link equation
};

void add(std::vector<RunTable>& tables, const DynamicFit& fit) {
  for (RunTable& table : tables) table.add(estimate(fit.parameters, table.name));
}

Comparison compare(const Cell& cell, int n_runs) {
  const ElasticResult stage1 = true_stage1();
  Comparison c;
  for (const auto& [name, value] : dynamic_truth(truth::Rig::low()))
    c.wls.push_back({name, value, {}, {}, 0, 0});
  c.iv = c.wls;
  for (int run = 0; run < n_runs; ++run) {
    const Bench bench = one_bench(cell, run);
    DynamicOptions options;
    options.samples.cutoff = cell.cutoff;
    options.estimator = "wls";
    add(c.wls, fit_dynamic(bench.logs(), stage1, options).preloads.at(0).fits.at(0));
    options.estimator = "iv";
    const DynamicFit fit = fit_dynamic(bench.logs(), stage1, options).preloads.at(0).fits.at(0);
    CHECK(fit.estimator == "iv");
    c.verdicts.push_back(fit.verdicts.at("link equation"));
    add(c.iv, fit);
  }
  RunTable::print_header("wls");
  for (const RunTable& t : c.wls) t.print();
  RunTable::print_header("iv");
  for (const RunTable& t : c.iv) t.print();
  return c;
}

const RunTable& table_of(const std::vector<RunTable>& tables, const std::string& name) {
  for (const RunTable& t : tables)
    if (t.name == name) return t;
  throw std::logic_error(name);
}

int n_runs() { return full_monte_carlo() ? 400 : 8; }

/// Link: within half an sd of these 60 s logs, or three standard errors of the mean of few runs.
/// Inertias within 1 %.
void check_unbiased(const Comparison& c) {
  for (const std::string name : {"J_link", "f_v", "f_s"}) {
    const RunTable& t = table_of(c.iv, name);
    INFO(name << " off by " << t.bias() << ", sd " << t.mean_sd());
    CHECK(std::abs(t.bias()) < std::max(0.5 * t.mean_sd(), 3 * t.standard_error()));
  }
  for (const std::string name : {"J_link", "J_motor"}) {
    const RunTable& t = table_of(c.iv, name);
    CHECK(std::abs(t.bias()) < 0.01 * t.truth);
  }
}

/// Pooled over the link's three parameters: the disturbance acts there.
void check_coverage(const Comparison& c) {
  double inside = 0, n = 0;
  for (const std::string name : {"J_link", "f_v", "f_s"}) {
    inside += static_cast<double>(table_of(c.iv, name).inside_interval);
    n += table_of(c.iv, name).n();
  }
  std::printf("    link, 95 %% intervals: %.1f %% of %g\n", 100 * inside / n, n);
  // f_v and f_s go together (correlation -0.9): two independent ones of three.
  CHECK(inside / n > 0.95 - 3.29 * std::sqrt(0.95 * 0.05 / (n * 2 / 3)));
}

TEST_CASE("a disturbance in a soft loop: wls is biased, iv is not", "[recover][monte-carlo]") {
  const Comparison c = compare({300, 3, {}}, n_runs());
  // -0.7 % of J_link at an sd of 0.5 %.
  CHECK(table_of(c.wls, "J_link").bias() < -0.004 * table_of(c.wls, "J_link").truth);
  check_unbiased(c);
  check_coverage(c);
  for (const std::string& verdict : c.verdicts) {
    INFO(verdict);
    CHECK(verdict.find("correlated with the residual (p < 0.001)") == 0);
    CHECK(verdict.find(": the iv estimates are used") != std::string::npos);
  }
}

// A band twice as wide as the noise of 16 bits allows: encoder noise in the acceleration.
TEST_CASE("encoder noise in a stiff loop: wls is biased, iv is not", "[recover][monte-carlo]") {
  const Comparison c = compare({800, 6, 160.0}, n_runs());
  CHECK(table_of(c.wls, "J_link").bias() < -0.02 * table_of(c.wls, "J_link").truth);
  check_unbiased(c);
  check_coverage(c);
}

// No controller in the rig file: the surrogate controller keeps the noise of q out of the
// instruments, the disturbance only in so far as it did not move theta.
TEST_CASE("encoder noise with an unknown controller", "[recover][monte-carlo]") {
  const Comparison c = compare({800, 6, 160.0, false}, n_runs());
  const RunTable& wls = table_of(c.wls, "J_link");
  const RunTable& iv = table_of(c.iv, "J_link");
  CHECK(std::abs(iv.bias()) < 0.02 * iv.truth);
  CHECK(std::abs(iv.bias()) < 0.2 * std::abs(wls.bias()));
}

}  // namespace
