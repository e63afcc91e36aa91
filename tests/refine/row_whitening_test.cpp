// Whitened rows are those of generalised least squares.
#include "cablefit/refine/row_whitening.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/random.hpp"
#include "cablefit/refine/remainder.hpp"

using namespace cablefit;

namespace {

constexpr double kPeriod = 1.0 / 128;  // s, exact
constexpr double kForever = 1e6;       // s
constexpr auto kLink = static_cast<std::size_t>(RowKind::link);
constexpr auto kMotor = static_cast<std::size_t>(RowKind::motor);

/// Of a torque that wanders (1 (N m)^2, correlation time 20 rows) and noise.
Eigen::VectorXd wandering(Eigen::Index n, double noise) {
  Eigen::VectorXd covariance(n);
  for (Eigen::Index lag = 0; lag < n; ++lag)
    covariance(lag) = std::exp(-static_cast<double>(lag) / 20);
  covariance(0) += noise;
  return covariance;
}

Eigen::MatrixXd toeplitz(const Eigen::VectorXd& covariance, Eigen::Index n) {
  Eigen::MatrixXd all(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) all(i, k) = covariance(std::abs(i - k));
  return all;
}

/// A row every `stride` samples.
Smoothing rows_every(Eigen::Index stride) {
  Smoothing smoothing;
  smoothing.stride = stride;
  smoothing.period = kPeriod;
  return smoothing;
}

KindRows rows_at(std::vector<Eigen::Index> at, RowKind kind = RowKind::link) {
  KindRows rows;
  rows.kind = kind;
  rows.at = std::move(at);
  return rows;
}

KindRows rows_from_0(Eigen::Index n) {
  KindRows rows = rows_at({});
  for (Eigen::Index i = 0; i < n; ++i) rows.at.push_back(i);
  return rows;
}

Eigen::MatrixXd columns(Eigen::Index n) {
  Random random(5);
  return Eigen::MatrixXd::NullaryExpr(n, 2, [&] { return random.normal(); });
}

RowWhitening link_whitening(const Eigen::VectorXd& covariance, double block_seconds = kForever) {
  std::array<Eigen::VectorXd, kRowKinds> all;
  all[kLink] = covariance;
  return {all, block_seconds};
}

}  // namespace

TEST_CASE("products of whitened rows are those of the inverse covariance", "[refine]") {
  constexpr Eigen::Index kRows = 12;  // none is predicted from fewer rows than there are
  const Eigen::VectorXd covariance = wandering(64, 0.3);
  const Eigen::MatrixXd c = columns(kRows);
  const Eigen::MatrixXd white = link_whitening(covariance).of(rows_from_0(kRows), rows_every(1), c);
  const Eigen::MatrixXd expected = c.transpose() * toeplitz(covariance, kRows).llt().solve(c);
  const Eigen::MatrixXd found = white.transpose() * white;
  // Both in units of their own: whitened rows stay in N m.
  CHECK((found / found(0, 0) - expected / expected(0, 0)).norm() < 1e-12);
}

TEST_CASE("every row is freed of the one before where no other says more", "[refine]") {
  constexpr Eigen::Index kRows = 30;
  const double memory = std::exp(-1.0 / 20);
  const Eigen::MatrixXd c = columns(kRows);
  const Eigen::MatrixXd white =
      link_whitening(wandering(64, 0)).of(rows_from_0(kRows), rows_every(1), c);
  Eigen::MatrixXd expected = c;
  expected.bottomRows(kRows - 1) -= memory * c.topRows(kRows - 1);
  expected.row(0) *= std::sqrt(1 - memory * memory);
  CHECK((white - expected).norm() < 1e-9);
}

TEST_CASE("whitened noise has no memory", "[refine]") {
  constexpr Eigen::Index kRows = 40000;
  constexpr double kNoise = 0.3;
  Random random(7);
  Eigen::VectorXd series(kRows);
  const double memory = std::exp(-1.0 / 20);
  double wander = random.normal();
  for (Eigen::Index i = 0; i < kRows; ++i) {
    series(i) = wander + std::sqrt(kNoise) * random.normal();
    wander = memory * wander + std::sqrt(1 - memory * memory) * random.normal();
  }
  const RowWhitening whitening = link_whitening(wandering(64, kNoise));
  const Eigen::VectorXd white = whitening.of(rows_from_0(kRows), rows_every(1), series);
  const auto correlation = [](const Eigen::VectorXd& x, Eigen::Index lag) {
    return x.head(kRows - lag).dot(x.tail(kRows - lag)) / x.squaredNorm();
  };
  CHECK(correlation(series, 1) > 0.7);
  for (const Eigen::Index lag : {1, 2, 5, 10}) CHECK(std::abs(correlation(white, lag)) < 0.02);
}

TEST_CASE("a hole and a block each begin a prediction anew", "[refine]") {
  constexpr Eigen::Index kHalf = 20, kRows = 2 * kHalf;  // more than a prediction looks back
  const Eigen::VectorXd covariance = wandering(64, 0.3);
  const Smoothing third = rows_every(3);
  const Eigen::MatrixXd c = columns(kRows);
  const auto halves = [&](const KindRows& first, const KindRows& second, const Smoothing& rows,
                          const RowWhitening& whitening) {
    Eigen::MatrixXd both(kRows, 2);
    both << whitening.of(first, rows, c.topRows(kHalf)),
        whitening.of(second, rows, c.bottomRows(kHalf));
    return both;
  };
  const RowWhitening whitening = link_whitening(covariance);
  std::vector<Eigen::Index> before, after;
  for (Eigen::Index i = 0; i < kHalf; ++i) {
    before.push_back(3 * i);
    after.push_back(3 * (kHalf + 1 + i));  // a row is missing
  }
  std::vector<Eigen::Index> all = before;
  all.insert(all.end(), after.begin(), after.end());
  CHECK(whitening.of(rows_at(all), third, c) ==
        halves(rows_at(before), rows_at(after), third, whitening));

  const RowWhitening blocks = link_whitening(covariance, kHalf * kPeriod);
  CHECK(blocks.of(rows_from_0(kRows), rows_every(1), c) ==
        halves(rows_from_0(kHalf), rows_from_0(kHalf), rows_every(1), blocks));
  CHECK(blocks.of(rows_from_0(kRows), rows_every(1), c) !=
        link_whitening(covariance).of(rows_from_0(kRows), rows_every(1), c));
}

TEST_CASE("rows of a kind without a memory stay as they are", "[refine]") {
  const Eigen::MatrixXd c = columns(3);
  CHECK_FALSE(RowWhitening().is_needed());
  const RowWhitening whitening = link_whitening(wandering(64, 0.3));
  CHECK(whitening.is_needed());
  CHECK(whitening.of(rows_at({0, 1, 2}, RowKind::motor), rows_every(1), c) == c);
}

TEST_CASE("what is no autocovariance ends the order", "[refine]") {
  Eigen::VectorXd impossible(3);
  impossible << 1, 0.5, -0.9;  // the determinant of three rows is negative
  Eigen::VectorXd start(2);
  start << 1, 0.5;
  const Eigen::MatrixXd c = columns(6);
  CHECK(link_whitening(impossible).of(rows_from_0(6), rows_every(1), c) ==
        link_whitening(start).of(rows_from_0(6), rows_every(1), c));
}

TEST_CASE("only rows that wander are whitened, and their noise as far as kernels let it pass",
          "[refine]") {
  // Noise behind a kernel: neighbours are alike, though what it came from was white.
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(64);
  noise.head(3) << 0.1, 0.06, 0.01;
  KindMemory sensors, left;
  for (const std::size_t kind : {kLink, kMotor}) sensors[kind] = {kPeriod, noise, 1000};
  left[kLink] = {kPeriod, wandering(64, 0) + noise, 1000};
  left[kMotor] = {kPeriod, 1.02 * noise, 1000};
  const RowWhitening whitening = whitening_of(left, sensors, kForever);
  const Eigen::MatrixXd c = columns(12);
  CHECK(whitening.of(rows_at({0, 1, 2}, RowKind::motor), rows_every(1), c.topRows(3)) ==
        c.topRows(3));

  Eigen::VectorXd expected(64);
  for (Eigen::Index lag = 0; lag < 64; ++lag)  // Bartlett's window
    expected(lag) = std::exp(-static_cast<double>(lag) / 20) * static_cast<double>(64 - lag) / 64;
  expected(0) += 0.1 + 2 * (0.06 + 0.01);
  const Eigen::MatrixXd same = link_whitening(expected).of(rows_from_0(12), rows_every(1), c);
  CHECK((whitening.of(rows_from_0(12), rows_every(1), c) - same).norm() < 1e-12);
}
