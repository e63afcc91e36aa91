// Starts of recordings that are far rougher than the rest.
#include "cablefit/refine/rows/rough_start.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

namespace {

using namespace cablefit;

/// 4 s at 1 kHz of a link that swings, and what is added to its position (rad) by time (s).
Recording swinging(const std::function<double(double)>& added) {
  constexpr Eigen::Index kSamples = 4000;
  Recording r;
  r.period = 1e-3;
  r.q = r.theta = Eigen::ArrayXd::Zero(kSamples);
  for (Eigen::Index i = 0; i < kSamples; ++i) {
    const double t = r.period * static_cast<double>(i);
    r.theta(i) = 0.3 * std::sin(2 * t + 0.4) + 0.02 * std::sin(20 * t);
    r.q(i) = r.theta(i) + added(t);
  }
  return r;
}

/// 0.02 rad at 40 Hz, gone after some 50 ms.
double ringing(double t) { return t > 0 ? 0.02 * std::exp(-t / 0.02) * std::sin(250 * t) : 0; }

TEST_CASE("rows leave out a start that is rougher than the rest", "[refine]") {
  CHECK(rough_start(swinging([](double) { return 0.0; })) == 0);  // it begins in motion
  const Eigen::Index after = rough_start(swinging(ringing));
  CHECK(after > 60);
  CHECK(after <= 90);
  // What happens again later belongs to the motion.
  CHECK(rough_start(swinging([](double t) { return ringing(t) + ringing(t - 2.5); })) == 0);
  // So does what happens later only.
  CHECK(rough_start(swinging([](double t) { return ringing(t - 0.5); })) == 0);
}

TEST_CASE("of a joint that moves first and then rests rows leave out little", "[refine]") {
  Recording r = swinging([](double) { return 0.0; });
  r.theta.tail(2000).setConstant(r.theta(1999));
  r.q = r.theta;
  CHECK(rough_start(r) <= 90);
}

}  // namespace
