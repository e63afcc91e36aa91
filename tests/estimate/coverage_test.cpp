// Are 95 % intervals 95 %? Residuals of an AR(1) process, as filtered robot data have them.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "cablefit/estimate/fit/least_squares.hpp"
#include "cablefit/estimate/solve/cell_places.hpp"
#include "cablefit/estimate/spread/autoregression.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

constexpr Eigen::Index kRows = 2000;

struct Coverage {
  double robust[2] = {0, 0}, white[2] = {0, 0};  // constant, sine
};

/// y = 0.5 + 2 sin(5 periods over the log) + AR(1) of unit variance.
Coverage coverage(double rho, int n_runs, std::uint64_t base_seed) {
  Coverage result;
  for (int run = 0; run < n_runs; ++run) {
    Normal normal(base_seed + static_cast<std::uint64_t>(run));
    Eigen::MatrixXd rows(kRows, 3);
    std::vector<Eigen::Index> numbers;
    double noise = normal();
    for (Eigen::Index i = 0; i < kRows; ++i) {
      const double sine = std::sin(2 * std::numbers::pi * 5 * static_cast<double>(i) / kRows);
      rows.row(i) << 1, sine, 0.5 + 2 * sine + noise;
      noise = rho * noise + std::sqrt(1 - rho * rho) * normal();
      numbers.push_back(i);
    }
    RowStatistics statistics(3, kRows);
    statistics.add(rows, numbers);
    const LinearSolution s =
        solve(statistics, {{0, 1}, {"constant", "sine"}, {}, Eigen::Vector3d(0, 0, 1)});
    const double truth[] = {0.5, 2};
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double error = std::abs(s.x(k) - truth[k]);
      const double t = t_quantile_975(s.degrees_of_freedom);
      result.robust[k] += (error < t * std::sqrt(s.covariance(k, k))) / static_cast<double>(n_runs);
      result.white[k] +=
          (error < 1.96 * std::sqrt(s.covariance_white(k, k))) / static_cast<double>(n_runs);
    }
  }
  return result;
}

int n_runs() { return test::full_monte_carlo() ? 4000 : 400; }

// 99.9 % band of a binomial share of 95 %: 3.29 sd = 3.6 % of 400 runs. 2000
// rows at rho = 0.9 are worth 2000 (1 - rho)/(1 + rho) = 105 independent ones, and a long-run
// variance estimated from that few is biased low: 2 % less than nominal is allowed for it.
TEST_CASE("honest intervals cover with coloured residuals, white ones do not", "[estimate]") {
  const double band = 3.29 * std::sqrt(0.95 * 0.05 / n_runs());
  const Coverage c = coverage(0.9, n_runs(), 6200);
  std::printf(
      "  coverage at rho 0.9: honest %.1f %% (constant), %.1f %% (sine); white %.1f, %.1f\n",
      100 * c.robust[0], 100 * c.robust[1], 100 * c.white[0], 100 * c.white[1]);
  for (int k = 0; k < 2; ++k) {
    CHECK(c.robust[k] > 0.95 - band - 0.02);
    CHECK(c.robust[k] < 0.95 + band);
    // The trap: without HAC the interval is sqrt((1 + rho)/(1 - rho)) = 4.4 times too short and
    // covers 2 Phi(1.96/4.36) - 1 = 35 %.
    CHECK(c.white[k] < 0.60);
  }
}

TEST_CASE("honest intervals cover with white residuals", "[estimate]") {
  const double band = 3.29 * std::sqrt(0.95 * 0.05 / n_runs());
  const Coverage c = coverage(0, n_runs(), 16200);
  std::printf("  coverage at rho 0: honest %.1f %%, %.1f %%; white %.1f, %.1f\n", 100 * c.robust[0],
              100 * c.robust[1], 100 * c.white[0], 100 * c.white[1]);
  for (int k = 0; k < 2; ++k) {
    CHECK(c.robust[k] > 0.95 - band);
    // sd is never below the white one: a little over nominal is meant.
    CHECK(c.robust[k] < 0.95 + band + 0.01);
    CHECK(c.white[k] > 0.95 - band);
  }
}

// SciPy 1.10.1: scipy.stats.t.ppf(0.975, dof).
TEST_CASE("Student's t", "[estimate]") {
  const std::pair<double, double> table[] = {
      {1, 12.706205}, {2, 4.302653},  {3, 3.182446},   {4, 2.776445},  {5, 2.570582},
      {6, 2.446912},  {8, 2.306004},  {10, 2.228139},  {15, 2.131450}, {20, 2.085963},
      {30, 2.042272}, {60, 2.000298}, {120, 1.979930}, {1e4, 1.960201}};
  for (const auto& [dof, quantile] : table) {
    INFO(dof << " degrees of freedom");
    // The header promises 1 %; the expansion is far better from 5 on.
    CHECK_THAT(t_quantile_975(dof), Catch::WithinRel(quantile, dof < 5 ? 0.01 : 0.001));
  }
}

// Long-run variance of an AR(1) of unit innovations: 1/(1 - rho)^2 per entry.
TEST_CASE("long-run variance of an AR(1)", "[estimate]") {
  for (const double rho : {-0.5, 0.0, 0.5, 0.9}) {
    double mean = 0;
    const int runs = 50;
    for (int run = 0; run < runs; ++run) {
      Normal normal(6300 + static_cast<std::uint64_t>(run));
      Eigen::MatrixXd x(5000, 1);
      double state = 0;
      for (Eigen::Index i = -200; i < 5000; ++i) {
        state = rho * state + normal();
        if (i >= 0) x(i, 0) = state;
      }
      mean += long_run_covariance(x).covariance(0, 0) / 5000 * (1 - rho) * (1 - rho) / runs;
    }
    INFO("rho " << rho << ", ratio " << mean);
    // 50 runs of relative sd below 0.12 (0.9): 2 % each way, and the kernel's known bias at 0.9.
    CHECK_THAT(mean, Catch::WithinAbs(1, rho > 0.8 ? 0.08 : 0.05));
  }
}

// Slow noise under a fast regressor: the influence of the rows has a spectrum with a dip at zero,
// of 1/2 |1 - rho exp(-i omega)|^-2 per entry there. Prewhitening of order 1 smoothed over the dip,
// by a factor of two.
TEST_CASE("long-run variance of slow noise times a fast regressor", "[estimate]") {
  constexpr double kRho = 0.9, kOmega = 0.6;
  double mean = 0;
  const int runs = 50;
  for (int run = 0; run < runs; ++run) {
    Normal normal(26300 + static_cast<std::uint64_t>(run));
    Eigen::MatrixXd x(2048, 1);
    double state = 0;
    for (Eigen::Index i = -200; i < 2048; ++i) {
      state = kRho * state + normal();
      if (i >= 0) x(i, 0) = std::cos(kOmega * static_cast<double>(i)) * state;
    }
    const double truth = 0.5 / (1 - 2 * kRho * std::cos(kOmega) + kRho * kRho);
    mean += long_run_covariance(x, kIntervalKernel).covariance(0, 0) / 2048 / truth / runs;
  }
  INFO("ratio " << mean);
  // About 64 degrees of freedom: relative sd 0.18 a run, 0.025 for 50; three of them, and what is
  // left of the dip's edges.
  CHECK_THAT(mean, Catch::WithinAbs(1, 0.15));
}

// White noise and slow noise below it, ARMA(1,1): a correlation of 0.33 at lag 1 with a long tail.
// 0.30 N m white and 0.08 N m of 0.2 s in rows of 40 ms after a low-pass of 10 Hz have this
// mixture.
TEST_CASE("long-run variance of slow noise below white noise", "[estimate]") {
  constexpr double kRho = 0.82, kSlow = 1.3;  // sd, of white noise 1
  const double slow = kSlow * kSlow;
  const double truth = 1 + slow * (1 + kRho) / (1 - kRho);
  double mean = 0, of_white = 0;
  const int runs = 60;
  for (int run = 0; run < runs; ++run) {
    Normal normal(36300 + static_cast<std::uint64_t>(run));
    Eigen::MatrixXd x(1000, 1), white(1000, 1);
    double state = kSlow * normal();
    for (Eigen::Index i = 0; i < 1000; ++i) {
      state = kRho * state + kSlow * std::sqrt(1 - kRho * kRho) * normal();
      white(i, 0) = normal();
      x(i, 0) = state + white(i, 0);
    }
    mean += interval_covariance(x).covariance(0, 0) / 1000 / truth / runs;
    of_white += interval_covariance(white).covariance(0, 0) / 1000 / runs;
  }
  INFO("ratio " << mean << ", of white noise alone " << of_white);
  // Relative sd below 0.35 a run: 0.045 for 60, three of them. An order of 1 gave 0.77.
  CHECK_THAT(mean, Catch::WithinAbs(1, 0.135));
  CHECK_THAT(of_white, Catch::WithinAbs(1, 0.1));
}

// Residuals are orthogonal to their regressors. Two coefficients that only the middle third of a
// record determines: what the fit takes out of just these rows has to be put back.
TEST_CASE("long-run variance of residuals, regressors that are there for a while", "[estimate]") {
  const Eigen::Index n = 990;
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n, 4);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n);
    const double x = std::sin(3 * std::numbers::pi * t);  // negative in the middle third
    w(i, 0) = std::max(0.0, x);
    w(i, 1) = std::min(0.0, x);
    w(i, 2) = w(i, 1) * w(i, 1);
    w(i, 3) = 1;
  }
  const Eigen::MatrixXd inverse = (w.transpose() * w).inverse();
  std::vector<Eigen::MatrixXd> information;
  for (Eigen::Index i = 0; i < n; ++i) information.push_back(w.row(i).transpose() * w.row(i));
  const FittedOut fitted = fitted_out(information, inverse);
  const Eigen::VectorXd truth = inverse.diagonal();
  Eigen::VectorXd plain = Eigen::VectorXd::Zero(4), restored = plain;
  const int runs = 60;
  for (int run = 0; run < runs; ++run) {
    Normal normal(46300 + static_cast<std::uint64_t>(run));
    Eigen::VectorXd noise(n);
    for (double& x : noise) x = normal();
    const Eigen::VectorXd residual = noise - w * (inverse * (w.transpose() * noise));
    const Eigen::MatrixXd influence = (w.array().colwise() * residual.array()).matrix() * inverse;
    plain += interval_covariance(influence).covariance.diagonal() / runs;
    restored += interval_covariance(influence, &fitted).covariance.diagonal() / runs;
  }
  for (Eigen::Index k = 1; k < 3; ++k) {
    INFO("coefficient " << k << ": " << restored(k) / truth(k) << ", without "
                        << plain(k) / truth(k));
    // As above, and what prewhitening and kernel do not see alike of what was taken out.
    CHECK_THAT(restored(k) / truth(k), Catch::WithinAbs(1, 0.2));
    CHECK(plain(k) < 0.85 * truth(k));  // the trap
  }
}

// Coefficients in N/m^3 and in N m are fitted together. In other units a variance changes by the
// square of the factor.
TEST_CASE("long-run variance does not depend on the units", "[estimate]") {
  const Eigen::Index n = 900;
  const Eigen::Vector4d unit(1e10, 1e4, 1, 1e-7);
  Normal normal(46350);
  Eigen::MatrixXd w(n, 4);
  Eigen::VectorXd residual(n);
  double slow = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = std::sin(0.02 * static_cast<double>(i));
    w.row(i) << 1, x, x * x, x * x * x;
    residual(i) = slow = 0.8 * slow + normal();
  }
  const auto variances = [&](const Eigen::MatrixXd& columns) -> Eigen::VectorXd {
    const Eigen::MatrixXd inverse = (columns.transpose() * columns).inverse();
    std::vector<Eigen::MatrixXd> information;
    for (Eigen::Index i = 0; i < n; ++i)
      information.push_back(columns.row(i).transpose() * columns.row(i));
    const FittedOut fitted = fitted_out(information, inverse);
    const Eigen::MatrixXd influence =
        (columns.array().colwise() * residual.array()).matrix() * inverse;
    return interval_covariance(influence, &fitted).covariance.diagonal();
  };
  const Eigen::VectorXd plain = variances(w);
  const Eigen::VectorXd scaled = variances(w * unit.cwiseInverse().asDiagonal());
  for (Eigen::Index k = 0; k < 4; ++k)
    CHECK_THAT(scaled(k) / (unit(k) * unit(k)), Catch::WithinRel(plain(k), 1e-6));
}

// What was taken out is put back in passes, each from the level that the one before found. Where a
// fit takes out more than is left the passes grow without end: a variance by 9 at most.
TEST_CASE("long-run variance grows by a bounded factor", "[estimate]") {
  const Eigen::Index n = 1000;
  Normal normal(46400);
  Eigen::MatrixXd series(n, 1);
  double x = 0;
  for (double& value : series.reshaped()) value = x = 0.9 * x + normal();
  const double plain = interval_covariance(series).covariance(0, 0);
  // The same autocovariances were taken out, times level / total: prewhitening and bandwidth are
  // those of the plain series.
  const auto growth = [&](double total) {
    const FittedOut fitted{{series}, Eigen::VectorXd::Constant(1, total)};
    return interval_covariance(series, &fitted).covariance(0, 0) / plain;
  };
  CHECK_THAT(growth(1e-3 * plain), Catch::WithinRel(9, 1e-6));
  CHECK_THAT(growth(1e-6 * plain), Catch::WithinRel(9, 1e-6));
  // 1 + 0.1 (1 + 0.1 (...)) where little was. The kernel sums of the whitened series and of its
  // autocovariances differ at the ends, by some lags in 1000 entries.
  CHECK_THAT(growth(10 * plain), Catch::WithinRel(1 / 0.9, 0.03));
}

// Brockwell & Davis 1991, (8.1.3): x = 0.5 x_1 + 0.3 x_2 + e has rho_1 = 0.5 / 0.7 and
// rho_2 = 0.5 rho_1 + 0.3; the recursion has to give back what made its autocovariance.
TEST_CASE("an autoregression from its autocovariance", "[estimate]") {
  const double rho_1 = 0.5 / 0.7, rho_2 = 0.5 * rho_1 + 0.3;
  Eigen::VectorXd covariance(3);
  covariance << 2, 2 * rho_1, 2 * rho_2;
  const Autoregression found = fit_autoregression(covariance, 1000);
  REQUIRE(found.coefficients.size() == 2);
  CHECK_THAT(found.coefficients[0], Catch::WithinAbs(0.5, 1e-12));
  CHECK_THAT(found.coefficients[1], Catch::WithinAbs(0.3, 1e-12));
  CHECK_THAT(found.sum(), Catch::WithinAbs(0.8, 1e-12));
  CHECK_THAT(found.innovation_variance,
             Catch::WithinAbs(2 * (1 - 0.5 * rho_1 - 0.3 * rho_2), 1e-12));
  CHECK(fit_autoregression(Eigen::VectorXd::Zero(3), 1000).coefficients.empty());
}

// Cells 3, 4, 9 of one log, then those of another that counts anew.
TEST_CASE("cells have their place in time", "[estimate]") {
  std::vector<GramCell> cells;
  for (const Eigen::Index id : {3, 4, 9, 0, 1, 100000}) cells.push_back({id, 1, {}});
  const std::vector<Eigen::Index> places = cell_places(cells);
  CHECK(places == std::vector<Eigen::Index>{0, 1, 6, 7, 8, 8 + kLongestGap});
  double next = 0;
  const Eigen::MatrixXd series = series_over_time(
      cells, 1, [&](const GramCell&) { return Eigen::RowVectorXd::Constant(1, ++next); });
  REQUIRE(series.rows() == 9 + kLongestGap);
  CHECK(series(1, 0) == 2);
  CHECK(series.block(2, 0, 4, 1).norm() == 0);
  CHECK(series(6, 0) == 3);
}

}  // namespace
