#include "cablefit/samples/rows/decimation.hpp"

#ifdef __x86_64__
#include <immintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "cablefit/base/divided_up.hpp"
#include "cablefit/base/lanes.hpp"

namespace cablefit {
namespace {

using Columns = Eigen::Ref<const Eigen::MatrixXd>;
using Values = Eigen::Ref<const Eigen::VectorXd>;

constexpr Eigen::Index kBlock = 16;                     // rows at a time, whose sums fill registers
constexpr double kBeside = 1.0 / 12, kMid = 10.0 / 12;  // the triangle's weights

/// taps * triangle (1, 10, 1)/12, one longer at either end.
Eigen::VectorXd averaging(const Values& taps) {
  const Eigen::Index n = taps.size();
  Eigen::VectorXd longer = Eigen::VectorXd::Zero(n + 2);
  longer.head(n) += kBeside * taps;
  longer.segment(1, n) += kMid * taps;
  longer.tail(n) += kBeside * taps;
  return longer;
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

/// Rows of the result that have all their taps, of centres `factor` rows apart.
struct Run {
  Eigen::Index row = 0, centre = 0, n = 0;
};

struct SplitRows {
  std::vector<Run> runs;
  std::vector<Eigen::Index> cut;  // rows of the result that lack taps
  Eigen::Index longest = 0;
};

template <class IsWhole>
SplitRows split(std::span<const Eigen::Index> centres, Eigen::Index factor, IsWhole is_whole) {
  SplitRows split;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!is_whole(centres[i])) {
      split.cut.push_back(row);
      continue;
    }
    const bool goes_on = !split.runs.empty() &&
                         split.runs.back().row + split.runs.back().n == row &&
                         centres[i] - centres[i - 1] == factor;
    if (!goes_on) split.runs.push_back({row, centres[i], 0});
    split.longest = std::max(split.longest, ++split.runs.back().n);
  }
  return split;
}

/// n > 0 values with the same bits.
bool is_constant(const double* x, Eigen::Index n) {
  return std::memcmp(x, x + 1, static_cast<std::size_t>(n - 1) * sizeof *x) == 0;
}

/// Every step-th of the values from `x` on, n of them.
void pick(const double* x, Eigen::Index step, Eigen::Index n, bool averaged, double* to) {
  if (averaged) {
    for (Eigen::Index i = 0; i < n; ++i, x += step) to[i] = kMid * x[0] + kBeside * (x[-1] + x[1]);
  } else {
    for (Eigen::Index i = 0; i < n; ++i, x += step) to[i] = x[0];
  }
}

/// Two values that have the same tap, as places of the first row of the result.
struct TapPair {
  Eigen::Index before = 0, after = 0;
  double tap = 0;
};

using Sums = std::array<double, kBlock>;
static_assert(kBlock == 4 * kLanes);

/// kBlock rows of the result. The values that one tap weighs are neighbours in memory, from `x` on.
void weigh(const double* x, const TapPair& middle, const std::vector<TapPair>& pairs, Sums& sums) {
  const double* const mid = x + middle.before;
  Lanes s0 = scaled(load(mid), middle.tap), s1 = scaled(load(mid + 4), middle.tap);
  Lanes s2 = scaled(load(mid + 8), middle.tap), s3 = scaled(load(mid + 12), middle.tap);
  for (const TapPair& pair : pairs) {
    const double *const a = x + pair.before, *const b = x + pair.after;
    s0 += scaled(load(a) + load(b), pair.tap);
    s1 += scaled(load(a + 4) + load(b + 4), pair.tap);
    s2 += scaled(load(a + 8) + load(b + 8), pair.tap);
    s3 += scaled(load(a + 12) + load(b + 12), pair.tap);
  }
  store(s0, sums.data());
  store(s1, sums.data() + 4);
  store(s2, sums.data() + 8);
  store(s3, sums.data() + 12);
}

#ifdef __x86_64__
/// The same four doubles a register where the machine has AVX2.
__attribute__((target("avx2"))) void weigh_wide(const double* x, const TapPair& middle,
                                                const std::vector<TapPair>& pairs, Sums& sums) {
  const double* const mid = x + middle.before;
  const __m256d mid_tap = _mm256_set1_pd(middle.tap);
  __m256d s0 = _mm256_loadu_pd(mid) * mid_tap, s1 = _mm256_loadu_pd(mid + 4) * mid_tap;
  __m256d s2 = _mm256_loadu_pd(mid + 8) * mid_tap, s3 = _mm256_loadu_pd(mid + 12) * mid_tap;
  for (const TapPair& pair : pairs) {
    const double *const a = x + pair.before, *const b = x + pair.after;
    const __m256d tap = _mm256_set1_pd(pair.tap);
    s0 += (_mm256_loadu_pd(a) + _mm256_loadu_pd(b)) * tap;
    s1 += (_mm256_loadu_pd(a + 4) + _mm256_loadu_pd(b + 4)) * tap;
    s2 += (_mm256_loadu_pd(a + 8) + _mm256_loadu_pd(b + 8)) * tap;
    s3 += (_mm256_loadu_pd(a + 12) + _mm256_loadu_pd(b + 12)) * tap;
  }
  _mm256_storeu_pd(sums.data(), s0);
  _mm256_storeu_pd(sums.data() + 4, s1);
  _mm256_storeu_pd(sums.data() + 8, s2);
  _mm256_storeu_pd(sums.data() + 12, s3);
}

const auto kWeigh = __builtin_cpu_supports("avx2") ? weigh_wide : weigh;
#else
const auto kWeigh = weigh;
#endif

/// The values of a run, sorted by phase. The values that one tap weighs for a block of rows are
/// then neighbours in memory.
class Phases {
 public:
  Phases(Eigen::Index factor, const Eigen::VectorXd& taps, Eigen::Index longest)
      : factor_(factor),
        reach_((taps.size() - 1) / factor),
        length_(divided_up(longest, kBlock) * kBlock + reach_),
        values_(length_, factor) {
    const Eigen::Index half = taps.size() / 2;
    middle_ = {place(half), place(half), taps(half)};
    for (Eigen::Index k = 1; k <= half; ++k)
      if (taps(half + k) != 0) pairs_.push_back({place(half - k), place(half + k), taps(half + k)});
  }

  /// `n` rows of the result; `x` is the first value that the first one weighs.
  void apply(const double* x, Eigen::Index n, bool averaged, double* to) {
    const Eigen::Index beside = averaged ? 1 : 0;
    const Eigen::Index n_values = (n + reach_ - 1) * factor_ + 1;
    if (is_constant(x - beside, n_values + 2 * beside)) {
      std::fill_n(to, n, *x);  // an offset, or a blocked link; a sum would add rounding
      return;
    }
    const Eigen::Index n_all = divided_up(n, kBlock) * kBlock + reach_;
    for (Eigen::Index phase = 0; phase < factor_; ++phase) {
      const Eigen::Index n_places = n + reach_ - (phase == 0 ? 0 : 1);
      pick(x + phase, factor_, n_places, averaged, values_.col(phase).data());
      // The last block has places beyond the last row.
      values_.col(phase).segment(n_places, n_all - n_places).setZero();
    }
    for (Eigen::Index i = 0; i < n; i += kBlock) {
      Sums sums;
      kWeigh(values_.data() + i, middle_, pairs_, sums);
      std::copy_n(sums.data(), std::min(kBlock, n - i), to + i);
    }
  }

 private:
  Eigen::Index place(Eigen::Index i) const { return i % factor_ * length_ + i / factor_; }

  Eigen::Index factor_, reach_, length_;
  Eigen::MatrixXd values_;  // places x phases
  TapPair middle_;
  std::vector<TapPair> pairs_;
};

}  // namespace

Decimation::Decimation(int factor, int lobes) : factor_(factor), lobes_(lobes) {
  using std::numbers::pi;
  const Eigen::Index half = half_width();
  taps_.resize(2 * half + 1);
  taps_(half) = 1;
  for (Eigen::Index k = 1; k <= half; ++k) {
    const double x = static_cast<double>(k) / factor_;
    const double sinc = k % factor_ == 0 ? 0 : std::sin(pi * x) / (pi * x);
    const double window =
        0.54 + 0.46 * std::cos(pi * static_cast<double>(k) / static_cast<double>(half));
    taps_(half + k) = taps_(half - k) = sinc * window;
  }
  taps_ /= taps_.sum();
}

void Decimation::apply_to(const Columns& columns, const std::vector<Eigen::Index>& which,
                          std::span<const Eigen::Index> centres, Eigen::Index first,
                          Eigen::Index last, bool averaged, Eigen::MatrixXd& out) const {
  if (which.empty()) return;
  const Eigen::Index half = half_width(), beside = averaged ? 1 : 0;
  const auto is_whole = [&](Eigen::Index centre) {
    return centre - half >= std::max(first, beside) && centre + half < last &&
           centre + half + beside < columns.rows();
  };
  const SplitRows rows = split(centres, factor_, is_whole);
  Phases phases(factor_, taps_, rows.longest);
  for (const Eigen::Index k : which)
    for (const Run& run : rows.runs)
      phases.apply(columns.col(k).data() + run.centre - half, run.n, averaged,
                   out.col(k).data() + run.row);
  for (const Eigen::Index row : rows.cut) {
    const Eigen::Index centre = centres[static_cast<std::size_t>(row)];
    const Eigen::Index from = std::max(first, centre - half);
    const Eigen::Index to = std::min(last, centre + half + 1);
    const auto inside = taps_.segment(from - (centre - half), to - from);
    const Stencil cut = cut_stencil(inside / inside.sum(), from, averaged, columns.rows());
    for (const Eigen::Index k : which)
      out(row, k) = dot(columns.col(k).data() + cut.from, cut.taps.data(), cut.taps.size());
  }
}

Eigen::MatrixXd Decimation::apply(const Columns& columns, std::span<const Eigen::Index> centres,
                                  Eigen::Index first, Eigen::Index last,
                                  const std::vector<bool>& averaged) const {
  std::vector<Eigen::Index> smooth, plain;
  for (Eigen::Index k = 0; k < columns.cols(); ++k)
    (!averaged.empty() && averaged[static_cast<std::size_t>(k)] ? smooth : plain).push_back(k);
  Eigen::MatrixXd out(static_cast<Eigen::Index>(centres.size()), columns.cols());
  apply_to(columns, smooth, centres, first, last, true, out);
  apply_to(columns, plain, centres, first, last, false, out);
  return out;
}

}  // namespace cablefit
