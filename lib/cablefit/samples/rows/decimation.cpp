#include "cablefit/samples/rows/decimation.hpp"

#ifdef __x86_64__
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Zeros behind the taps, up to a whole number of lanes.
Eigen::VectorXd padded(const Eigen::VectorXd& taps) {
  Eigen::VectorXd longer = Eigen::VectorXd::Zero((taps.size() + kLanes - 1) / kLanes * kLanes);
  longer.head(taps.size()) = taps;
  return longer;
}

/// Weighted sums of four columns: each tap loaded serves all four. The taps are whole lanes.
void weigh_four(const double* x, Eigen::Index stride, const Eigen::VectorXd& taps, double* to,
                Eigen::Index to_stride) {
  Lanes s0, s1, s2, s3;  // by name: an array of them would be zeroed in memory
  const double *x1 = x + stride, *x2 = x1 + stride, *x3 = x2 + stride;
  for (Eigen::Index i = 0; i < taps.size(); i += kLanes) {
    const Lanes tap = load(taps.data() + i);
    s0.add_product(tap, load(x + i));
    s1.add_product(tap, load(x1 + i));
    s2.add_product(tap, load(x2 + i));
    s3.add_product(tap, load(x3 + i));
  }
  to[0] = s0.sum();
  to[to_stride] = s1.sum();
  to[2 * to_stride] = s2.sum();
  to[3 * to_stride] = s3.sum();
}

#ifdef __x86_64__
/// The same four doubles a register where the machine has AVX2, added up in the same order.
__attribute__((target("avx2"))) void weigh_four_wide(const double* x, Eigen::Index stride,
                                                     const Eigen::VectorXd& taps, double* to,
                                                     Eigen::Index to_stride) {
  __m256d s0 = _mm256_setzero_pd(), s1 = s0, s2 = s0, s3 = s0;
  const double *x1 = x + stride, *x2 = x1 + stride, *x3 = x2 + stride;
  for (Eigen::Index i = 0; i < taps.size(); i += kLanes) {
    const __m256d tap = _mm256_loadu_pd(taps.data() + i);
    s0 += tap * _mm256_loadu_pd(x + i);
    s1 += tap * _mm256_loadu_pd(x1 + i);
    s2 += tap * _mm256_loadu_pd(x2 + i);
    s3 += tap * _mm256_loadu_pd(x3 + i);
  }
  const __m256d s01 = _mm256_hadd_pd(s0, s1), s23 = _mm256_hadd_pd(s2, s3);
  const __m128d t01 = _mm256_castpd256_pd128(s01) + _mm256_extractf128_pd(s01, 1);
  const __m128d t23 = _mm256_castpd256_pd128(s23) + _mm256_extractf128_pd(s23, 1);
  to[0] = t01[0];
  to[to_stride] = t01[1];
  to[2 * to_stride] = t23[0];
  to[3 * to_stride] = t23[1];
}

const auto kWeighFour = __builtin_cpu_supports("avx2") ? weigh_four_wide : weigh_four;
#else
const auto kWeighFour = weigh_four;
#endif

/// Row `row` of `out`: weighted sums of the columns over the rows from `from` on.
void weigh(const Columns& columns, Eigen::Index from, const Eigen::VectorXd& taps, Eigen::Index row,
           Eigen::MatrixXd& out) {
  const double* const x = columns.data() + from;
  const Eigen::Index stride = columns.outerStride(), n = columns.cols();
  if (taps.size() % kLanes != 0 || n < 4) {
    for (Eigen::Index k = 0; k < n; ++k)
      out(row, k) = dot(x + k * stride, taps.data(), taps.size());
    return;
  }
  for (Eigen::Index k = 0; k < n; k += 4) {
    const Eigen::Index first = std::min(k, n - 4);  // the last four may overlap those before
    kWeighFour(x + first * stride, stride, taps, &out(row, first), out.rows());
  }
}

/// Taps that do not all fit, for the rows from `from` on.
struct Stencil {
  Eigen::Index from = 0;
  Eigen::VectorXd taps;
};

/// Averaged as far as there are rows, the sum of the taps 1.
Stencil cut_stencil(const Eigen::VectorXd& inside, Eigen::Index from, bool averaged,
                    Eigen::Index n_rows) {
  if (!averaged) return {from, inside};
  const Eigen::VectorXd longer = averaging(inside);
  const Eigen::Index first = std::max<Eigen::Index>(0, from - 1);
  const Eigen::Index last = std::min(n_rows, from + inside.size() + 1);
  const Eigen::VectorXd taps = longer.segment(first - (from - 1), last - first);
  return {first, taps / taps.sum()};
}

}  // namespace

Decimation::Decimation(int factor, int lobes) : factor_(factor), lobes_(lobes) {
  using std::numbers::pi;
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
  padded_taps_ = padded(taps_);
  padded_averaging_taps_ = padded(averaging(taps_));
}

void Decimation::apply_to(const Columns& columns, std::span<const Eigen::Index> centres,
                          Eigen::Index first, Eigen::Index last, bool averaged,
                          Eigen::MatrixXd& out) const {
  const Eigen::Index half = half_width(), reach = averaged ? 1 : 0;
  const Eigen::VectorXd& usual = averaged ? padded_averaging_taps_ : padded_taps_;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Index from = std::max(first, centres[i] - half);
    const Eigen::Index to = std::min(last, centres[i] + half + 1);
    const bool is_whole =
        to - from == taps_.size() && from >= reach && from - reach + usual.size() <= columns.rows();
    if (is_whole) {
      weigh(columns, from - reach, usual, row, out);
    } else {
      const auto inside = taps_.segment(from - (centres[i] - half), to - from);
      const Stencil cut = cut_stencil(inside / inside.sum(), from, averaged, columns.rows());
      weigh(columns, cut.from, cut.taps, row, out);
    }
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
