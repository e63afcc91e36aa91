#include "cablefit/samples/decimation.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/lanes.hpp"

namespace cablefit {
namespace {

using Columns = Eigen::Ref<const Eigen::MatrixXd>;

/// taps * triangle (1, 10, 1)/12, one longer at either end.
Eigen::VectorXd averaging(const Eigen::Ref<const Eigen::VectorXd>& taps) {
  const Eigen::Index n = taps.size();
  Eigen::VectorXd longer = Eigen::VectorXd::Zero(n + 2);
  longer.head(n) += taps / 12;
  longer.segment(1, n) += taps * (10.0 / 12);
  longer.tail(n) += taps / 12;
  return longer;
}

/// Weighted sums of four columns: each tap loaded serves all four.
void weigh_four(const double* x, Eigen::Index stride, const Eigen::VectorXd& taps, double* to,
                Eigen::Index to_stride) {
  Lanes sums[4];
  const Eigen::Index n = taps.size();
  Eigen::Index i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    const Lanes tap = load(taps.data() + i);
    for (Eigen::Index k = 0; k < 4; ++k) sums[k].add_product(tap, load(x + k * stride + i));
  }
  for (Eigen::Index k = 0; k < 4; ++k) {
    double rest = 0;
    for (Eigen::Index j = i; j < n; ++j) rest += taps(j) * x[k * stride + j];
    to[k * to_stride] = sums[k].sum() + rest;
  }
}

/// Row `row` of `out`: weighted sums of the columns over the rows from `from` on.
void weigh(const Columns& columns, Eigen::Index from, const Eigen::VectorXd& taps, Eigen::Index row,
           Eigen::MatrixXd& out) {
  const double* const x = columns.data() + from;
  const Eigen::Index stride = columns.outerStride(), n = columns.cols();
  Eigen::Index k = 0;
  for (; k + 4 <= n; k += 4) weigh_four(x + k * stride, stride, taps, &out(row, k), out.rows());
  for (; k < n; ++k) out(row, k) = dot(x + k * stride, taps.data(), taps.size());
}

}  // namespace

Decimation::Decimation(int factor) : factor_(factor) {
  constexpr double pi = 3.14159265358979323846;
  const Eigen::Index half = half_width();
  taps_.resize(2 * half + 1);
  for (Eigen::Index k = -half; k <= half; ++k) {
    const double x = static_cast<double>(k) / factor_;
    const double sinc = k == 0 ? 1 : std::sin(pi * x) / (pi * x);
    const double window =
        half == 0 ? 1
                  : 0.54 + 0.46 * std::cos(pi * static_cast<double>(k) / static_cast<double>(half));
    taps_(half + k) = sinc * window;
  }
  taps_ /= taps_.sum();
  averaging_taps_ = averaging(taps_);
}

void Decimation::apply_to(const Columns& columns, std::span<const Eigen::Index> centres,
                          Eigen::Index first, Eigen::Index last, bool averaged,
                          Eigen::MatrixXd& out) const {
  const Eigen::Index half = half_width(), reach = averaged ? 1 : 0;
  const Eigen::VectorXd& usual = averaged ? averaging_taps_ : taps_;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Index from = std::max(first, centres[i] - half);
    const Eigen::Index to = std::min(last, centres[i] + half + 1);
    if (to - from == taps_.size()) {
      weigh(columns, from - reach, usual, row, out);
      continue;
    }
    const auto inside = taps_.segment(from - (centres[i] - half), to - from);
    const Eigen::VectorXd scaled = inside / inside.sum();
    weigh(columns, from - reach, averaged ? averaging(scaled) : scaled, row, out);
  }
}

Eigen::MatrixXd Decimation::apply(const Columns& columns, std::span<const Eigen::Index> centres,
                                  Eigen::Index first, Eigen::Index last,
                                  const std::vector<bool>& averaged) const {
  const auto n = static_cast<Eigen::Index>(centres.size());
  const bool any = std::find(averaged.begin(), averaged.end(), true) != averaged.end();
  Eigen::MatrixXd out(n, columns.cols());
  apply_to(columns, centres, first, last, any, out);
  Eigen::MatrixXd plain(n, 1);
  for (std::size_t k = 0; any && k < averaged.size(); ++k) {
    if (averaged[k]) continue;
    apply_to(columns.col(static_cast<Eigen::Index>(k)), centres, first, last, false, plain);
    out.col(static_cast<Eigen::Index>(k)) = plain;
  }
  return out;
}

}  // namespace cablefit
