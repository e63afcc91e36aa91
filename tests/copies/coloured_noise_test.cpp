// Noise as coloured as a residual.
#include "cablefit/copies/coloured_noise.hpp"

#include <catch2/catch.hpp>
#include <numeric>

namespace {

using namespace cablefit;

/// x_i = a x_(i-1) + b x_(i-2) + e, unit innovations.
Eigen::VectorXd second_order(Eigen::Index n, double a, double b, std::uint64_t seed) {
  Random random(seed);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n + 200);
  for (Eigen::Index i = 2; i < x.size(); ++i) x(i) = a * x(i - 1) + b * x(i - 2) + random.normal();
  return x.tail(n);
}

std::vector<Eigen::Index> counted(Eigen::Index n) {
  std::vector<Eigen::Index> numbers(static_cast<std::size_t>(n));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

Autocovariance of(const Eigen::VectorXd& x, std::size_t n_lags) {
  Autocovariance c(n_lags);
  c.add(counted(x.size()), x);
  return c;
}

TEST_CASE("autocovariance, with and without holes") {
  const Eigen::VectorXd x = (Eigen::VectorXd(5) << 1, 2, 3, 4, 5).finished();
  const Eigen::VectorXd whole = of(x, 3).values();
  CHECK(whole(0) == 11);                // (1 + 4 + 9 + 16 + 25) / 5
  CHECK(whole(1) == 10);                // (2 + 6 + 12 + 20) / 4
  CHECK(whole(2) == Approx(26.0 / 3));  // (3 + 8 + 15) / 3
  Autocovariance holed(3);
  holed.add(std::vector<Eigen::Index>{0, 1}, x.head(2));
  holed.add(std::vector<Eigen::Index>{3, 4}, x.tail(2));  // 2 is missing
  CHECK(holed.values()(1) == 11);                         // (2 + 20) / 2
  CHECK(holed.values()(2) == 8);                          // 2 * 4, one pair
  CHECK(holed.n_values() == 4);
}

TEST_CASE("an autoregression is found again") {
  const Eigen::VectorXd x = second_order(40000, 1.2, -0.5, 3);
  const Autocovariance c = of(x, 12);
  const ArModel model = fit_ar(c.values(), 0.004, c.n_values());
  REQUIRE(model.coefficients.size() >= 2);
  // sd of a coefficient is sqrt((1 - 0.5^2) / 40000) = 0.0043; 4 of them, as AIC may add orders.
  CHECK(std::abs(model.coefficients[0] - 1.2) < 0.02);
  CHECK(std::abs(model.coefficients[1] + 0.5) < 0.02);
  CHECK(std::abs(model.innovation_sd - 1) < 4 / std::sqrt(2 * 40000.0));
}

TEST_CASE("drawn noise has the colour that was asked for") {
  const Eigen::VectorXd x = second_order(40000, 1.2, -0.5, 4);
  const Autocovariance asked = of(x, 12);
  const ArModel model = fit_ar(asked.values(), 0.004, asked.n_values());
  Random random(9);
  const Eigen::ArrayXd drawn = draw(model, 200000, 0.004, random);
  const Eigen::VectorXd found = of(drawn.matrix(), 6).values();
  // Relative sd of a variance over n rows of this process, by Bartlett's formula sqrt(2 sum rho^2 /
  // n) with sum rho^2 about 5: 0.016 for 40,000 and less for the drawn ones; 4 of them.
  for (Eigen::Index k = 0; k < 6; ++k)
    CHECK(std::abs(found(k) - asked.values()(k)) < 0.07 * asked.values()(0));
  // Four times as fast: linear between its own values, every fourth is one of them.
  Random same(9);
  const Eigen::ArrayXd fine = draw(model, 801, 0.001, same);
  for (Eigen::Index i = 0; i < 200; ++i) {
    CHECK(fine(4 * i) == Approx(drawn(i)).margin(1e-9));
    CHECK(fine(4 * i + 2) == Approx((drawn(i) + drawn(i + 1)) / 2).margin(1e-9));
  }
}

TEST_CASE("what is no autocovariance makes no noise") {
  CHECK(fit_ar(Eigen::Vector3d(-1, 0, 0), 1, 100).sd == 0);
  Random random(1);
  CHECK((draw(ArModel{1, {}, 0, 0}, 10, 1, random) == 0).all());
  // Correlation 1 at lag 1 is not positive definite: white noise of the same sd remains.
  const ArModel white = fit_ar(Eigen::Vector3d(4, 4, 0), 1, 100);
  CHECK(white.coefficients.empty());
  CHECK(white.innovation_sd == 2);
}

}  // namespace
