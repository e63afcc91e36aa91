// What no curve explains: rows of nearly the same deflection, on one branch of the motion, do not
// agree (pure error of Draper & Smith 1998, 2.1, about lines instead of means).
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

#include "cablefit/elastic/bases/cable_bases.hpp"

namespace cablefit {
namespace {

constexpr int kFloorBins = 48;    // of the range, per branch
constexpr double kFewRows = 5;    // of a bin
constexpr double kFewInAll = 40;  // degrees of freedom

/// Sums of a straight line through the rows of a bin.
struct BinLine {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  void add(double at, double value) {
    n += 1, x += at, y += value;
    xx += at * at, xy += at * value, yy += value * value;
  }
  double rss() const {
    const double sxx = xx - x * x / n, sxy = xy - x * y / n, syy = yy - y * y / n;
    return std::max(0.0, syy - (sxx > 0 ? sxy * sxy / sxx : 0));
  }
};

}  // namespace

double scatter_about_lines(const BlockedRows& rows) {
  const BlockedColumns& c = rows.columns;
  const double width = (rows.deflection_high - rows.deflection_low) / kFloorBins;
  std::array<BinLine, 2 * kFloorBins> bins{};
  rows.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index>) {
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      const double along = (r(i, c.deflection) - rows.deflection_low) / width;
      const int bin = std::clamp(static_cast<int>(along), 0, kFloorBins - 1);
      const int branch = r(i, c.direction) > 0 ? 1 : 0;
      bins[static_cast<std::size_t>(2 * bin + branch)].add(along - bin - 0.5, r(i, c.tau));
    }
  });
  double squares = 0, freedom = 0;
  for (const BinLine& bin : bins) {
    if (bin.n < kFewRows) continue;
    squares += bin.rss();
    freedom += bin.n - 2;
  }
  return freedom >= kFewInAll ? std::sqrt(squares / freedom)
                              : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace cablefit
