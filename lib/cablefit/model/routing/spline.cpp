#include "cablefit/model/routing/spline.hpp"

#include <algorithm>
#include <cassert>

namespace cablefit::maps {
namespace {

/// Solves a tridiagonal system in place (Thomas), without pivots: the spline's is diagonally
/// dominant. Row i: lower[i] z[i-1] + diagonal[i] z[i] + upper[i] z[i+1] = right[i].
void solve_tridiagonal(const std::vector<double>& lower, std::vector<double>& diagonal,
                       const std::vector<double>& upper, std::vector<double>& right) {
  const std::size_t n = right.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) right[i] -= upper[i] * right[i + 1];
    right[i] /= diagonal[i];
  }
}

}  // namespace

std::vector<double> spline_curvature(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  assert(n >= 2 && y.size() == n);
  std::vector<double> curvature(n, 0.0);
  if (n == 2) return curvature;
  const auto width = [&](std::size_t i) { return x[i + 1] - x[i]; };
  const auto chord = [&](std::size_t i) { return (y[i + 1] - y[i]) / width(i); };
  const std::size_t inner = n - 2;
  std::vector<double> lower(inner), diagonal(inner), upper(inner), right(inner);
  for (std::size_t i = 0; i < inner; ++i) {
    lower[i] = width(i);
    diagonal[i] = 2 * (width(i) + width(i + 1));
    upper[i] = width(i + 1);
    right[i] = 6 * (chord(i + 1) - chord(i));
  }
  // Not-a-knot: the curvature of an end continues the line through its two neighbours', with three
  // points it is theirs. That eliminates both ends from the first and last row.
  const double first = inner > 1 ? width(0) / width(1) : 0.0;
  const double last = inner > 1 ? width(n - 2) / width(n - 3) : 0.0;
  diagonal.front() += lower.front() * (1 + first);
  upper.front() -= lower.front() * first;
  diagonal.back() += width(n - 2) * (1 + last);
  lower.back() -= width(n - 2) * last;
  solve_tridiagonal(lower, diagonal, upper, right);
  std::copy(right.begin(), right.end(), curvature.begin() + 1);
  curvature.front() = curvature[1] - first * (curvature[inner > 1 ? 2 : 1] - curvature[1]);
  curvature.back() = curvature[n - 2] + last * (curvature[n - 2] - curvature[n > 3 ? n - 3 : 1]);
  return curvature;
}

SplineValue spline_at(const std::vector<double>& x, const std::vector<double>& y,
                      const std::vector<double>& curvature, double at) {
  const double inside = std::clamp(at, x.front(), x.back());
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, inside);
  const auto i = static_cast<std::size_t>(above - x.begin()) - 1;
  const double h = x[i + 1] - x[i];
  const double a = x[i + 1] - inside, b = inside - x[i];
  const double ca = curvature[i], cb = curvature[i + 1];
  const double chord = (y[i + 1] - y[i]) / h;
  const double value = y[i] + b * chord - a * b * (ca * (h + a) + cb * (h + b)) / (6 * h);
  const double slope = chord + (cb * (3 * b * b - h * h) - ca * (3 * a * a - h * h)) / (6 * h);
  if (at != inside) return {value + slope * (at - inside), slope, 0.0};
  return {value, slope, (ca * a + cb * b) / h};
}

}  // namespace cablefit::maps
