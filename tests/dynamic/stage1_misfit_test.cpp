// A blocked curve that no polynomial of the cables describes bends stage 2 by how much its
// residual curve says, and the intervals know it.
#include <numbers>

#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// A ripple with the deflection, N m, and a loop beyond friction that grows with the deflection.
struct Extra {
  double ripple = 0, loop = 0;
};

truth::Log blocked(const Extra& extra, std::uint64_t seed = 3) {
  truth::BlockedOptions options;
  options.duration = 40;
  options.seed = seed;
  truth::Log log = truth::simulate_blocked(truth::Rig::low(), options);
  double direction = 1, last = log.theta.front();
  for (std::size_t i = 0; i < log.t.size(); ++i) {
    if (std::abs(log.theta[i] - last) > 2e-4) {
      direction = log.theta[i] > last ? 1 : -1;
      last = log.theta[i];
    }
    const double phi = log.theta[i] - log.q[i];
    log.tau[i] += extra.ripple * std::sin(2 * std::numbers::pi * phi / 0.02) +
                  extra.loop * direction * std::cos(std::numbers::pi * phi / 0.05);
  }
  return log;
}

double largest(const ElasticMisfit& misfit, double MisfitPoint::*part) {
  double most = 0;
  for (const MisfitPoint& point : misfit.points) most = std::max(most, std::abs(point.*part));
  return most;
}

ElasticResult stage1_of(const Extra& extra) {
  Bench bench;
  bench.add(blocked(extra));
  return fit_elastic(bench.logs(), {});
}

const ElasticMisfit& misfit_of(const ElasticResult& result) {
  const ElasticPreload& preload = result.preloads.at(0);
  return preload.find(preload.selected)->misfit;
}

TEST_CASE("cables that the model describes leave no misfit", "[elastic]") {
  const ElasticResult result = stage1_of({});
  CHECK(result.preloads.at(0).selected == "poly");
  CHECK(misfit_of(result).empty());
}

TEST_CASE("a ripple is a curve, and a loop is a loop", "[elastic]") {
  const ElasticResult ripple = stage1_of({1.5, 0});
  CHECK(largest(misfit_of(ripple), &MisfitPoint::torque) > 0.3);
  CHECK(largest(misfit_of(ripple), &MisfitPoint::half_width) < 0.2);
  const ElasticResult loop = stage1_of({0, 14});
  CHECK(largest(misfit_of(loop), &MisfitPoint::torque) < 0.5);
  CHECK(largest(misfit_of(loop), &MisfitPoint::half_width) > 2);
  const ElasticMisfit& m = misfit_of(loop);
  const MisfitPoint between = m.at((m.points[0].deflection + m.points[1].deflection) / 2);
  CHECK(between.half_width ==
        Approx((m.points[0].half_width + m.points[1].half_width) / 2).margin(1e-12));
  CHECK(m.at(-1).torque == m.points.front().torque);
  CHECK(m.at(1).torque == m.points.back().torque);
}

// The moving log has no ripple: stage 2 is wrong by what stage 1 says it may be.
TEST_CASE("stage 2 carries the misfit into its intervals", "[dynamic]") {
  Bench bench;
  truth::MovingOptions options;
  options.seed = 5;
  bench.add(truth::simulate_moving(truth::Rig::low(), options));
  const ElasticResult with = stage1_of({1.5, 0});
  ElasticResult without = with;
  for (ElasticFit& fit : without.preloads.at(0).fits) fit.misfit = {};
  DynamicOptions dynamic;
  dynamic.models = {"poly"};
  const DynamicPreload carried = fit_dynamic(bench.logs(), with, dynamic).preloads.at(0);
  const DynamicPreload plain = fit_dynamic(bench.logs(), without, dynamic).preloads.at(0);
  const DynamicFit& fit = carried.fits.at(0);
  CHECK(plain.fits.at(0).stage1_misfit.empty());
  for (const auto& [name, value] : dynamic_truth(truth::Rig::low())) {
    const Estimate& e = estimate(fit.parameters, name);
    if (!e.not_identifiable.empty()) continue;
    const double own = estimate(plain.fits.at(0).parameters, name).sd;
    const double misfit = fit.stage1_misfit.at(name);
    std::printf("    %s: %.4g, sd %.2g without, misfit %.2g, error %.2g\n", name.c_str(), e.value,
                own, misfit, e.value - value);
    CHECK(e.sd == Approx(std::hypot(own, misfit)).epsilon(1e-6));
    CHECK(e.ci_low <= value);
    CHECK(value <= e.ci_high);
  }
  bool said = false;
  for (const Decision& d : carried.decisions)
    said |= d.name.find("stage 1's misfit") != std::string::npos;
  CHECK(said);
}

}  // namespace
