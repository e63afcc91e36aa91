// A low-frequency disturbance of the logs is the same in the draws of the null distribution.
#include "cablefit/refine/null/remainder.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace cablefit;

namespace {

constexpr Eigen::Index kLags = 64;
constexpr double kWander = 0.01, kNoise = 0.0013;  // (N m)^2
constexpr auto kLink = static_cast<std::size_t>(RowKind::link);

/// A torque with a correlation time of 50 rows, and noise that the next row has forgotten.
KindMemory memory(double wander, double noise) {
  KindMemory all;
  all[kLink] = {0.006, Eigen::VectorXd(kLags), 10000};
  for (Eigen::Index lag = 0; lag < kLags; ++lag)
    all[kLink].covariance(lag) =
        wander * std::exp(-static_cast<double>(lag) / 50) + (lag == 0 ? noise : 0);
  return all;
}

/// What rows remember of a disturbance: it and their own noise.
KindMemory drawn_with(KindMemory disturbance) {
  disturbance[kLink].covariance(0) += kNoise;
  return disturbance;
}

}  // namespace

TEST_CASE("draws wander as the logs do, not as logs and noise together", "[refine]") {
  const KindMemory left = memory(kWander, kNoise);
  const KindMemory guess = remainder_of(left, {std::sqrt(kNoise), 1, 1});
  CHECK(guess[kLink].covariance(0) == Approx(kWander));
  CHECK(guess[kLink].covariance(40) <
        0.9 * left[kLink].covariance(40));  // too little of it is slow
  const KindMemory better = corrected(guess, left, drawn_with(guess));
  for (const Eigen::Index lag : {0, 1, 40})
    CHECK(better[kLink].covariance(lag) == Approx(memory(kWander, 0)[kLink].covariance(lag)));
  const CopyDisturbance torque = as_disturbance(better, true);
  CHECK(torque.link.front().sd == Approx(std::sqrt(kWander)));
  CHECK(torque.motor.front().sd == 0);
}

TEST_CASE("rows at their floor are not disturbed", "[refine]") {
  const KindMemory guess = remainder_of(memory(1e-5, kNoise), {std::sqrt(kNoise), 1, 1});
  CHECK(is_quiet(as_disturbance(guess, true)));
}
