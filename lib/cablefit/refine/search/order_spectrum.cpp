#include "cablefit/refine/search/order_spectrum.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace cablefit {
namespace {

// rad, from one evaluation to the next at the usual speed: twice as many would pass for slow ones.
constexpr double kMostPhase = std::numbers::pi;
constexpr double kBinsPerPeriod = 8;  // of the highest order: its phase is off by 0.4 rad at most
constexpr std::size_t kMostPositionBins = 1 << 16;

/// Whether a row is of the motor's equation: a blocked link leaves the motor's.
bool is_of_motor(const KindRows& rows) { return rows.kind != RowKind::link; }

struct Range {
  double low = kUnbounded, high = -kUnbounded;
};

template <typename Use>
void for_each_motor_row(const Design& design, const Eigen::VectorXd& x, Use use) {
  const VariantColumns all = residuals(design.rows, x);
  for (std::size_t s = 0; s < design.rows.size(); ++s)
    for (std::size_t k = 0; k < design.rows[s].kinds.size(); ++k) {
      const KindRows& rows = design.rows[s].kinds[k];
      if (!is_of_motor(rows)) continue;
      for (std::size_t i = 0; i < rows.at.size(); ++i)
        use(design.rows[s].motion->theta(rows.at[i]), all[s][k](static_cast<Eigen::Index>(i)));
    }
}

/// Longest time between two evaluations of a column.
double evaluation_period(const Design& design) {
  double longest = 0;
  for (std::size_t s = 0; s < design.stretches.size(); ++s) {
    const Smoothing smoothing = design.smoothing_of(s);
    longest = std::max(longest, static_cast<double>(smoothing.every) * smoothing.period);
  }
  return longest;
}

/// Sum of the residual by position under a Hann window, 2^m bins and as many empty ones: lines
/// between two orders of the transform show then, too.
std::vector<double> by_position(const Design& design, const Eigen::VectorXd& x, const Range& range,
                                double width) {
  const auto n_bins = static_cast<std::size_t>((range.high - range.low) / width) + 1;
  std::size_t size = 2;
  while (size < 2 * n_bins) size *= 2;
  std::vector<double> bins(size, 0.0);
  for_each_motor_row(design, x, [&](double theta, double residual) {
    const double along = theta - range.low;
    const double hann = std::sin(std::numbers::pi * along / (range.high - range.low));
    bins[static_cast<std::size_t>(along / width)] += hann * hann * residual;
  });
  return bins;
}

}  // namespace

std::vector<double> strongest_orders(const Design& design, const Eigen::VectorXd& x, double lowest,
                                     int n) {
  Range range;
  for_each_motor_row(design, x, [&](double theta, double /*residual*/) {
    range.low = std::min(range.low, theta);
    range.high = std::max(range.high, theta);
  });
  const double length = range.high - range.low;
  if (!(length > 0)) return {};
  const double resolved =
      2 * std::numbers::pi * static_cast<double>(kMostPositionBins) / (2 * kBinsPerPeriod * length);
  const double highest =
      std::min(kMostPhase / (design.scale.speed * evaluation_period(design)), resolved);
  if (!(highest > lowest)) return {};
  const double width = 2 * std::numbers::pi / (kBinsPerPeriod * highest);
  const std::vector<double> bins = by_position(design, x, range, width);
  std::vector<std::complex<double>> lines;
  Eigen::FFT<double> transform;
  transform.fwd(lines, bins);
  const double step = 2 * std::numbers::pi / (static_cast<double>(bins.size()) * width);
  std::vector<std::pair<double, double>> peaks;  // power, order
  for (std::size_t k = 1; k + 1 < bins.size() / 2; ++k) {
    const double before = std::norm(lines[k - 1]), at = std::norm(lines[k]),
                 after = std::norm(lines[k + 1]);
    if (at < before || at <= after) continue;
    const double between = 0.5 * (before - after) / (before - 2 * at + after);  // parabola
    const double order = (static_cast<double>(k) + between) * step;
    if (order > lowest && order < highest) peaks.emplace_back(at, order);
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> orders;
  const double lobe = 4 * std::numbers::pi / length;  // half the width of a line in this window
  for (const auto& [power, order] : peaks) {
    const bool is_apart = std::all_of(orders.begin(), orders.end(), [&, at = order](double other) {
      return std::abs(at - other) > lobe;
    });
    if (is_apart && orders.size() < static_cast<std::size_t>(n)) orders.push_back(order);
  }
  return orders;
}

}  // namespace cablefit
