// Taps against SciPy 1.10.1: scipy.signal.firwin(20*M + 1, 1/M, window='hamming'), centre outwards.
#include "cablefit/samples/rows/decimation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace {

using cablefit::Decimation;

const std::vector<double> kTaps2 = {0.5005906769851869,
                                    0.3168810886636905,
                                    0,
                                    -0.1009026556925601,
                                    0,
                                    0.05514981755928865,
                                    0,
                                    -0.03409191053679766,
                                    0,
                                    0.02166922119799296,
                                    0,
                                    -0.01355980053420345,
                                    0,
                                    0.008118263300045461,
                                    0,
                                    -0.004562113924115426,
                                    0,
                                    0.002439578210617314,
                                    0,
                                    -0.001436826736551794,
                                    0};
const std::vector<double> kTaps5 = {0.200294681688131,
                                    0.1872034484450089,
                                    0.1510385217064804,
                                    0.1002354981287826,
                                    0.04616641342576026,
                                    0,
                                    -0.03022013926974403,
                                    -0.04141482778565689,
                                    -0.03574078828845764,
                                    -0.01932842982486222,
                                    0,
                                    0.01523578603213116,
                                    0.02211486250549276,
                                    0.01993717438197448,
                                    0.01115160292926883,
                                    0,
                                    -0.009210349598634751,
                                    -0.01358243714658196,
                                    -0.01239417618782637,
                                    -0.006995317452059411};

Eigen::RowVectorXd row_at(const Decimation& decimation, const Eigen::MatrixXd& columns,
                          Eigen::Index centre, Eigen::Index first, Eigen::Index last) {
  return decimation.apply(columns, {&centre, 1}, first, last, {});
}

/// Response of the centre row to an impulse `away` rows from it.
double tap(const Decimation& decimation, Eigen::Index away) {
  const Eigen::Index n = 2 * decimation.half_width() + 11;
  Eigen::MatrixXd impulse = Eigen::MatrixXd::Zero(n, 1);
  impulse(n / 2 + away, 0) = 1;
  return row_at(decimation, impulse, n / 2, 0, n)(0);
}

void check_taps(int factor, const std::vector<double>& expected) {
  const Decimation decimation(factor);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const auto away = static_cast<Eigen::Index>(k);
    INFO("factor " << factor << ", tap " << k);
    CHECK_THAT(tap(decimation, away), Catch::WithinAbs(expected[k], 1e-15));
    CHECK(tap(decimation, -away) == tap(decimation, away));
  }
  CHECK(tap(decimation, 10 * factor + 1) == 0);
  CHECK(decimation.half_width() == 10 * factor);
}

TEST_CASE("decimation taps are SciPy's", "[samples]") {
  check_taps(2, kTaps2);
  check_taps(5, kTaps5);
}

TEST_CASE("decimation by one does nothing", "[samples]") {
  const Decimation decimation(1);
  CHECK(decimation.half_width() == 0);
  Eigen::MatrixXd x(3, 2);
  x << 1, 2, 3, 4, 5, 6;
  const Eigen::RowVectorXd out = row_at(decimation, x, 1, 0, 3);
  CHECK(out(0) == 3);
  CHECK(out(1) == 4);
}

// An equation that holds row by row must hold after decimation, at the ends of a log too, where
// taps are missing: all columns lose the same ones. A constant stays what it is there.
TEST_CASE("columns stay parallel and constants stay constant at the ends", "[samples]") {
  const Eigen::Index n = 200;
  Eigen::MatrixXd columns(n, 4);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = std::sin(0.2 * static_cast<double>(i)),
                 y = std::cos(0.031 * static_cast<double>(i * i % 97));
    columns.row(i) << x, y, 3 * x - 2 * y + 0.5, 1;
  }
  for (const int factor : {2, 5, 10}) {
    const Decimation decimation(factor);
    for (const Eigen::Index centre : {0L, 1L, 7L, 100L, 195L, 199L}) {
      const Eigen::RowVectorXd out = row_at(decimation, columns, centre, 0, n);
      INFO("factor " << factor << ", row " << centre);
      CHECK_THAT(out(3), Catch::WithinAbs(1, 1e-14));
      CHECK_THAT(3 * out(0) - 2 * out(1) + 0.5 * out(3), Catch::WithinAbs(out(2), 1e-13));
      // Rows outside [first, last) must not be looked at.
      Eigen::MatrixXd poisoned = columns;
      poisoned.topRows(centre >= 50 ? 40 : 0).setConstant(1e300);
      const Eigen::RowVectorXd clean =
          row_at(decimation, poisoned, centre, centre >= 50 ? 40 : 0, n);
      CHECK(clean.cwiseAbs().maxCoeff() < 10);
    }
  }
}

TEST_CASE("averaged columns have weights (1, 10, 1)/12 on top of the taps", "[samples]") {
  const std::vector<Eigen::Index> centres = {1, 2, 3, 4, 5};
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(7, 2);
  x.row(3).setConstant(12);
  const Eigen::MatrixXd out = Decimation(1).apply(x, centres, 0, 7, {true, false});
  const auto near = [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return (a - b).cwiseAbs().maxCoeff() < 1e-14;
  };
  CHECK(near(out.col(0), (Eigen::VectorXd(5) << 0, 1, 10, 1, 0).finished()));
  CHECK(near(out.col(1), (Eigen::VectorXd(5) << 0, 0, 12, 0, 0).finished()));

  // The average comes after the decimation's taps: both are means, so their order does not matter.
  const Eigen::Index n = 101;
  Eigen::MatrixXd wave(n, 1), averaged(n, 1);
  for (Eigen::Index i = 0; i < n; ++i) wave(i) = std::sin(0.3 * static_cast<double>(i * i));
  averaged = wave;
  for (Eigen::Index i = 1; i + 1 < n; ++i)
    averaged(i) = (wave(i - 1) + 10 * wave(i) + wave(i + 1)) / 12;
  const std::vector<Eigen::Index> middle = {40, 45, 50, 55, 60};
  const Decimation decimation(3);
  CHECK(near(decimation.apply(wave, middle, 0, n, {true}),
             decimation.apply(averaged, middle, 0, n, {})));
}

// Rows of a run are computed together. The result must not depend on where runs begin and end.
TEST_CASE("rows of a run are those of each row alone", "[samples]") {
  const Eigen::Index n = 1200;
  Eigen::MatrixXd columns(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
    columns.row(i) << std::sin(0.3 * static_cast<double>(i * i)), i < 700 ? 2.5 : 0.1, 0.25;
  const std::vector<bool> averaged = {true, false, true};
  for (const int factor : {1, 2, 5}) {
    std::vector<Eigen::Index> centres;
    for (Eigen::Index at = 0; at < n; at += factor)
      if (at % 300 > 40 && at != 600) centres.push_back(at);
    const Decimation decimation(factor);
    const Eigen::MatrixXd all = decimation.apply(columns, centres, 0, n, averaged);
    for (std::size_t k = 0; k < centres.size(); ++k) {
      const Eigen::MatrixXd one =
          decimation.apply(columns, std::span(&centres[k], 1), 0, n, averaged);
      const Eigen::RowVectorXd row = all.row(static_cast<Eigen::Index>(k));
      CHECK(row(0) == one(0, 0));
      // A constant stretch is copied, without rounding.
      CHECK_THAT(row(1), Catch::WithinAbs(one(0, 1), 1e-14));
      CHECK_THAT(row(2), Catch::WithinAbs(0.25, 1e-15));
    }
  }
}

TEST_CASE("averages take the rows there are at both ends", "[samples]") {
  const Eigen::MatrixXd constant = Eigen::MatrixXd::Constant(7, 5, 2);
  const std::vector<Eigen::Index> centres = {0, 1, 2, 3, 4, 5, 6};
  for (const int factor : {1, 2, 5}) {
    const Eigen::MatrixXd out =
        Decimation(factor).apply(constant, centres, 0, 7, {true, true, true, true, false});
    CHECK((out - constant).cwiseAbs().maxCoeff() < 1e-14);
  }
}

}  // namespace
