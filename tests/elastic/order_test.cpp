// Held-out blocks must not add orders that are not there: at most 5 % false additions
// (estimation-rules), on white and on coloured torque noise.
#include "tests/elastic/curves.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Cables of order 1 (1500 and 1900 N m/rad), five sweeps in 20 s at 100 Hz.
std::string log_text(double rho, std::uint64_t seed) {
  Normal normal(seed);
  double noise = normal();
  std::string text = "t,q,theta,tau\n";
  for (int i = 0; i < 2000; ++i) {
    const double phase = 2 * std::numbers::pi * 5 * i / 2000.0;
    const double phi = 0.04 * std::sin(phase);
    const double tau = (phi > 0 ? 1500 : 1900) * phi + 2 * sign(std::cos(phase)) + 0.3 * noise;
    noise = rho * noise + std::sqrt(1 - rho * rho) * normal();
    text += fmt::format("{:.3f},0,{:.9f},{:.6f}\n", 0.01 * i, phi, tau);
  }
  return text;
}

int false_additions(double rho, int n_runs, std::uint64_t base_seed) {
  int added = 0;
  for (int run = 0; run < n_runs; ++run) {
    Bench bench;
    bench.add_text(log_text(rho, base_seed + static_cast<std::uint64_t>(run)));
    const ElasticPreload preload = fit_elastic(bench.logs(), {}).preloads.at(0);
    added += preload.find("poly")->order > 1;
  }
  return added;
}

TEST_CASE("no order is added to linear cables", "[elastic]") {
  const int n_runs = full_monte_carlo() ? 1000 : 200;
  for (const double rho : {0.0, 0.9}) {
    const int added = false_additions(rho, n_runs, rho > 0 ? 4500 : 4300);
    std::printf("  false additions, rho %.1f: %d of %d\n", rho, added, n_runs);
    INFO("rho " << rho);
    CHECK(added <= n_runs / 20);
  }
}

// The trap: with a real second order the same logs must show it.
TEST_CASE("an order that is there is added", "[elastic]") {
  const std::string text = log_text(0, 4700);
  Bench bench;
  std::string curved = "t,q,theta,tau\n";
  for (std::size_t at = text.find('\n') + 1; at < text.size(); at = text.find('\n', at) + 1) {
    double t = 0, q = 0, theta = 0, tau = 0;
    REQUIRE(std::sscanf(text.c_str() + at, "%lf,%lf,%lf,%lf", &t, &q, &theta, &tau) == 4);
    tau += sign(theta) * 5000 * theta * theta;  // 8 N m at 40 mrad
    curved += fmt::format("{:.3f},0,{:.9f},{:.6f}\n", t, theta, tau);
  }
  bench.add_text(curved);
  CHECK(fit_elastic(bench.logs(), {}).preloads.at(0).find("poly")->order == 2);
}

/// Cable 1 stiffens (8 N m at 40 mrad), cable 2 does not.
std::string one_stiffens() {
  Normal normal(4800);
  std::string text = "t,q,theta,tau\n";
  for (int i = 0; i < 4000; ++i) {
    const double phase = 2 * std::numbers::pi * 10 * i / 4000.0;
    const double phi = 0.04 * std::sin(phase);
    const double cables = phi > 0 ? 1500 * phi + 5000 * phi * phi : 1900 * phi;
    const double tau = cables + 2 * sign(std::cos(phase)) + 0.3 * normal();
    text += fmt::format("{:.3f},0,{:.9f},{:.6f}\n", 0.01 * i, phi, tau);
  }
  return text;
}

ElasticFit cables_of(const ElasticOptions& options) {
  Bench bench;
  bench.add_text(one_stiffens());
  return *fit_elastic(bench.logs(), options).preloads.at(0).find("poly");
}

// 5000 of the rows' sd of a coefficient, a few hundred at most: 3 sd are far from 0.
TEST_CASE("each cable has the order that it needs", "[elastic]") {
  const ElasticFit poly = cables_of({});
  CHECK(orders_of(poly.transmission) == std::vector<int>{2, 1});
  CHECK(model_text(poly) == "poly, orders 2, 1");
  check_recovered(poly.parameters, {{"K1_0", 1500}, {"K1_1", 5000}, {"K2_0", 1900}}, 4);
  CHECK(find_estimate(poly.parameters, "K2_1") == nullptr);
}

TEST_CASE("one order per cable can be given", "[elastic]") {
  ElasticOptions options;
  options.orders = {1, 3};
  const ElasticFit poly = cables_of(options);
  CHECK(orders_of(poly.transmission) == options.orders);
  CHECK(poly.order == 3);
  options.orders = {1, 2, 2};
  CHECK_THROWS_WITH(cables_of(options),
                    "--order gives 3 orders, but there are 2 cables; give one order for all, or "
                    "one per cable in the order of the rig file");
}

}  // namespace
