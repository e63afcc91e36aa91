#include "cablefit/samples/rows/butterworth.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

namespace cablefit {
namespace {

using std::numbers::pi;
constexpr int kAtOnce =
    4;  // columns filtered side by side, so that the recursion fills the pipeline
using Lane = Eigen::Array<double, kAtOnce, 1>;

struct State {
  Lane s1 = Lane::Zero(), s2 = Lane::Zero();
};

// Transposed direct form II; the state that holds a constant input x at its steady output (DC gain
// 1).
State steady(const Biquad& section, const Lane& x) {
  State state;
  state.s2 = (section.b2 - section.a2) * x;
  state.s1 = (section.b1 - section.a1) * x + state.s2;
  return state;
}

/// N sections in a row over n values from `x` on, `step` (1 or -1) apart. N is known to the
/// compiler, and the sections are unrolled, so that all states stay in registers.
template <std::size_t N>
void sweep(const Biquad* sections, Lane* x, std::size_t n, std::ptrdiff_t step) {
  std::array<Biquad, N> c;
  std::array<State, N> states;
  std::copy_n(sections, N, c.begin());
  // All sections have DC gain 1, so the first value is every section's steady input.
  for (std::size_t k = 0; k < N; ++k) states[k] = steady(c[k], *x);
  for (std::size_t i = 0; i < n; ++i, x += step) {
    Lane v = *x;
#pragma GCC unroll 2
    for (std::size_t k = 0; k < N; ++k) {
      State& s = states[k];
      const Lane y = c[k].b0 * v + s.s1;
      s.s1 = c[k].b1 * v - c[k].a1 * y + s.s2;
      s.s2 = c[k].b2 * v - c[k].a2 * y;
      v = y;
    }
    *x = v;
  }
}

void pass(const std::vector<Biquad>& sections, Lane* x, std::size_t n, std::ptrdiff_t step) {
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
  std::vector<Lane> x(static_cast<std::size_t>(before + n + after), Lane::Zero());
  for (Eigen::Index first = 0; first < columns.cols(); first += kAtOnce) {
    const int lanes = static_cast<int>(std::min<Eigen::Index>(kAtOnce, columns.cols() - first));
    for (int lane = 0; lane < lanes; ++lane) {
      const auto column = columns.col(first + lane);
      for (Eigen::Index i = 0; i < before; ++i)
        x[static_cast<std::size_t>(i)](lane) = 2 * column(0) - column(before - i);
      for (Eigen::Index i = 0; i < n; ++i)
        x[static_cast<std::size_t>(before + i)](lane) = column(i);
      for (Eigen::Index i = 0; i < after; ++i)
        x[static_cast<std::size_t>(before + n + i)](lane) = 2 * column(n - 1) - column(n - 2 - i);
    }
    pass(sections_, x.data(), x.size(), 1);
    pass(sections_, x.data() + x.size() - 1, x.size(), -1);
    for (int lane = 0; lane < lanes; ++lane)
      for (Eigen::Index i = 0; i < n; ++i)
        columns(i, first + lane) = x[static_cast<std::size_t>(before + i)](lane);
  }
}

}  // namespace cablefit
