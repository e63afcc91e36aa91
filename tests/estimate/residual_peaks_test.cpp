// The largest residual told from one pass must be the largest residual, or not be told.
#include "cablefit/estimate/tests/residual_peaks.hpp"

#include <catch2/catch.hpp>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

struct Case {
  Eigen::MatrixXd rows;
  Eigen::VectorXd fit;
};

Case make_case(std::uint64_t seed) {
  Normal normal(seed);
  Case c{Eigen::MatrixXd(5000, 3), Eigen::Vector3d(-0.5, 2, 1)};
  for (Eigen::Index i = 0; i < c.rows.rows(); ++i) {
    c.rows.row(i) << normal(), normal() + 1, 0;
    c.rows(i, 2) = 0.5 * c.rows(i, 0) - 2 * c.rows(i, 1) + 0.1 * normal();
  }
  return c;
}

ResidualPeaks peaks_of(const Case& c, const Eigen::VectorXd& guess) {
  ResidualPeaks all(guess);
  for (Eigen::Index begin = 0; begin < c.rows.rows(); begin += 700) {
    ResidualPeaks some = all.empty_copy();
    some.add(c.rows.middleRows(begin, std::min<Eigen::Index>(700, c.rows.rows() - begin)));
    all.add(std::move(some));
  }
  return all;
}

TEST_CASE("a good guess tells the largest residual", "[estimate]") {
  for (std::uint64_t seed = 7100; seed < 7120; ++seed) {
    const Case c = make_case(seed);
    const double truth = (c.rows * c.fit).cwiseAbs().maxCoeff();
    const ResidualPeaks peaks = peaks_of(c, c.fit + Eigen::Vector3d(2e-4, -2e-4, 0));
    const auto largest = peaks.largest(0, c.fit);
    REQUIRE(largest);
    CHECK_THAT(*largest, Catch::WithinRel(truth, 1e-14));
  }
}

TEST_CASE("a guess that may have missed the largest residual does not tell", "[estimate]") {
  int told = 0;
  for (std::uint64_t seed = 7120; seed < 7140; ++seed) {
    const Case c = make_case(seed);
    const double truth = (c.rows * c.fit).cwiseAbs().maxCoeff();
    const auto largest = peaks_of(c, c.fit + Eigen::Vector3d(0.2, -0.3, 0)).largest(0, c.fit);
    told += largest.has_value();
    if (largest) CHECK_THAT(*largest, Catch::WithinRel(truth, 1e-14));
  }
  CHECK(told == 0);
}

TEST_CASE("a batch smaller than what is kept holds no other rows", "[estimate]") {
  ResidualPeaks peaks(Eigen::VectorXd::Ones(1));
  peaks.add(Eigen::MatrixXd::Constant(3, 1, -2));
  CHECK(peaks.largest(0, Eigen::VectorXd::Constant(1, 10)) == 20.0);
  CHECK(ResidualPeaks(Eigen::VectorXd::Ones(1)).largest(0, Eigen::VectorXd::Ones(1)) == 0.0);
}

}  // namespace
