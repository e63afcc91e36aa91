// Samples at standstill: the torque lies anywhere in the friction band, so that a fit to them makes
// f_sm too low. The log is arithmetic, its friction known.
#include <random>

#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kFriction = 2;  // N m

/// Ramps of 1 s and stops of 1 s in turn, up and down between -40 and 40 mrad. At a stop the torque
/// is anywhere in the band.
std::string stop_and_go() {
  std::mt19937 random(4900);
  std::uniform_real_distribution<double> band(-1, 1);
  std::string text = "t,q,theta,tau\n";
  double theta = 0, way = 1, at_stop = 0;
  for (int i = 0; i < 12000; ++i) {
    const bool moves = i / 100 % 2 == 0;
    if (i % 200 == 100) at_stop = band(random);
    if (moves) theta += way * 1e-4;
    if (std::abs(theta) > 0.04) way = theta > 0 ? -1 : 1;
    const double tau = 1800 * theta + kFriction * (moves ? way : at_stop);
    text += fmt::format("{:.3f},0,{:.9f},{:.6f}\n", 0.01 * i, theta, tau);
  }
  return text;
}

ElasticPreload fitted(std::optional<double> rest_speed) {
  Bench bench;
  bench.add_text(stop_and_go());
  ElasticOptions options;
  options.order = 1;
  options.samples.rest_speed = rest_speed;
  return fit_elastic(bench.logs(), options).preloads.at(0);
}

double friction_of(const ElasticPreload& preload) {
  return estimate(preload.find("poly")->parameters, "f_sm").value;
}

TEST_CASE("kept standstill samples are warned about, with the f_sm without them", "[elastic]") {
  const ElasticPreload kept = fitted(0.0);
  print_all("warning", kept.warnings);
  CHECK(friction_of(kept) < 0.8 * kFriction);
  CHECK(warns(kept.warnings, "--rest-speed 0 keeps samples at standstill"));
  CHECK(warns(kept.warnings, "is too low; samples in motion alone give"));
}

TEST_CASE("without --rest-speed they are left out, and nothing is said", "[elastic]") {
  const ElasticPreload moving = fitted(std::nullopt);
  CHECK(std::abs(friction_of(moving) - kFriction) < 0.02 * kFriction);
  CHECK_FALSE(warns(moving.warnings, "standstill"));
}

}  // namespace
