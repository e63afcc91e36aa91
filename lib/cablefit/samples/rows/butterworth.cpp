#include "cablefit/samples/rows/butterworth.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "cablefit/base/lanes.hpp"

namespace cablefit {
namespace {

using std::numbers::pi;

/// One section (transposed direct form II) of two columns. The next state is computed from the
/// state, not from the output: that needs two operations one after the other instead of four.
class Section {
 public:
  Section() = default;
  /// In the steady state of a constant input `x`. All sections have DC gain 1, so the first value
  /// is every section's steady input.
  Section(const Biquad& c, Pair x)
      : b0_(c.b0),
        b1_(c.b1 - c.a1 * c.b0),
        b2_(c.b2 - c.a2 * c.b0),
        a1_(c.a1),
        a2_(c.a2),
        s2_((c.b2 - c.a2) * x),
        s1_((c.b1 - c.a1) * x + s2_) {}
  Pair advance(Pair x) {
    const Pair y = b0_ * x + s1_;
    const Pair next = (b1_ * x + s2_) - a1_ * s1_;
    s2_ = b2_ * x - a2_ * s1_;
    s1_ = next;
    return y;
  }

 private:
  double b0_ = 0, b1_ = 0, b2_ = 0, a1_ = 0, a2_ = 0;
  Pair s2_{}, s1_{};
};

/// N sections in a row over n values from `x` on, `step` (1 or -1) apart. N is known to the
/// compiler, and the sections are unrolled, so that all states stay in registers.
template <std::size_t N>
void sweep(const Biquad* sections, Pair* x, std::size_t n, std::ptrdiff_t step) {
  std::array<Section, N> row;
  for (std::size_t k = 0; k < N; ++k) row[k] = Section(sections[k], *x);
  for (std::size_t i = 0; i < n; ++i, x += step) {
    Pair v = *x;
#pragma GCC unroll 2
    for (std::size_t k = 0; k < N; ++k) v = row[k].advance(v);
    *x = v;
  }
}

void pass(const std::vector<Biquad>& sections, Pair* x, std::size_t n, std::ptrdiff_t step) {
  std::size_t k = 0;
  for (; k + 2 <= sections.size(); k += 2) sweep<2>(&sections[k], x, n, step);
  for (; k < sections.size(); ++k) sweep<1>(&sections[k], x, n, step);
}

}  // namespace

Butterworth::Butterworth(int order, double cutoff, double rate) {
  assert(order >= 1 && cutoff > 0 && cutoff < rate / 2);
  const double warped = std::tan(pi * cutoff / rate);
  double slowest = 0;
  for (int k = 0; k < (order + 1) / 2; ++k) {
    const bool single = order % 2 == 1 && k == order / 2;
    const double angle = pi * (2.0 * k + 1) / (2.0 * order);
    Biquad c;
    if (single) {
      const double a0 = 1 + warped;
      c = {warped / a0, warped / a0, 0, (warped - 1) / a0, 0};
      slowest = std::max(slowest, std::abs(c.a1));
    } else {
      const double damping = 2 * std::sin(angle) * warped;
      const double w2 = warped * warped;
      const double a0 = 1 + damping + w2;
      c = {w2 / a0, 2 * w2 / a0, w2 / a0, 2 * (w2 - 1) / a0, (1 - damping + w2) / a0};
      slowest = std::max(slowest, std::sqrt(std::abs(c.a2)));
    }
    sections_.push_back(c);
  }
  settling_rows_ = static_cast<Eigen::Index>(std::ceil(std::log(1e-10) / std::log(slowest)));
}

void Butterworth::apply(Eigen::Ref<Eigen::MatrixXd> columns, bool odd_start, bool odd_end) const {
  const Eigen::Index n = columns.rows();
  if (n < 2) return;
  const Eigen::Index pad = std::min(n - 1, settling_rows_);
  const Eigen::Index before = odd_start ? pad : 0;
  const Eigen::Index after = odd_end ? pad : 0;
  std::vector<Pair> x(static_cast<std::size_t>(before + n + after));
  const auto at = [&](Eigen::Index i) -> Pair& { return x[static_cast<std::size_t>(before + i)]; };
  for (Eigen::Index first = 0; first < columns.cols(); first += 2) {
    const Eigen::Index second = std::min(first + 1, columns.cols() - 1);  // the last may be alone
    auto a = columns.col(first), b = columns.col(second);
    for (Eigen::Index i = 0; i < n; ++i) at(i) = Pair{a(i), b(i)};
    for (Eigen::Index i = 1; i <= before; ++i) at(-i) = 2.0 * at(0) - at(i);
    for (Eigen::Index i = 1; i <= after; ++i) at(n - 1 + i) = 2.0 * at(n - 1) - at(n - 1 - i);
    pass(sections_, x.data(), x.size(), 1);
    pass(sections_, x.data() + x.size() - 1, x.size(), -1);
    for (Eigen::Index i = 0; i < n; ++i) a(i) = at(i)[0];
    for (Eigen::Index i = 0; i < n; ++i) b(i) = at(i)[second - first];
  }
}

}  // namespace cablefit
