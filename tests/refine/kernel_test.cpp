// Smoothing kernels do exactly what they promise of 1, t and t^2.
#include "cablefit/refine/rows/kernel.hpp"

#include <catch2/catch.hpp>

using namespace cablefit;

namespace {

constexpr double kPeriod = 1e-3, kSd = 2.5e-3;

Eigen::ArrayXd times(Eigen::Index n) {
  return kPeriod * Eigen::ArrayXd::LinSpaced(n, 0, static_cast<double>(n - 1));
}

}  // namespace

/// The trap: a truncated second derivative that does not give 0 of a constant makes an acceleration
/// of -29 rad/s^2 of every rad of position, and with it a "gravity" that nobody hid.
TEST_CASE("derivative kernels have the moments of derivatives", "[refine]") {
  const Eigen::ArrayXd t = times(400);
  const Eigen::ArrayXd x = 3 + 2 * t + 5 * t.square();
  const auto middle = [](const Eigen::ArrayXd& y) { return Eigen::ArrayXd(y.segment(50, 300)); };
  const Eigen::ArrayXd slope = apply(gaussian_slope(kSd, kPeriod), x) - (2 + 10 * t);
  const Eigen::ArrayXd bend = apply(gaussian_curvature(kSd, kPeriod), x) - 10;
  // Rounding: 3 / period^2 * 1e-16.
  CHECK(middle(slope).abs().maxCoeff() < 1e-10);
  CHECK(middle(bend).abs().maxCoeff() < 1e-8);
  CHECK(middle(apply(gaussian(kSd, kPeriod), 3 + 2 * t) - (3 + 2 * t)).abs().maxCoeff() < 1e-12);
}

TEST_CASE("a kernel at chosen rows is the kernel at all rows", "[refine]") {
  const Eigen::ArrayXd x = (40 * times(200)).sin();
  const Kernel slope = gaussian_slope(kSd, kPeriod);
  const Eigen::ArrayXd everywhere = apply(slope, x);
  const std::vector<Eigen::Index> rows = {40, 41, 99, 150};
  const Eigen::MatrixXd at = apply_at(slope, x.matrix(), rows);
  for (std::size_t i = 0; i < rows.size(); ++i)
    CHECK(at(static_cast<Eigen::Index>(i), 0) == Approx(everywhere(rows[i])).epsilon(1e-12));
}
