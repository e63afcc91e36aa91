#include "cablefit/simulate/coupled_friction.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

// Patterns: n joints leave or come to rest a few times each. Rounding alone could make a pattern
// come twice; what is left then is no larger than that.
std::size_t most_patterns(std::size_t n) { return 20 + 10 * n; }

}  // namespace

bool factorise(double* a, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    double* row = a + n * j;
    for (std::size_t k = 0; k < j; ++k) {
      double sum = row[k];
      for (std::size_t i = 0; i < k; ++i) sum -= row[i] * a[n * k + i];
      row[k] = sum / a[n * k + k];
    }
    double pivot = row[j];
    for (std::size_t i = 0; i < j; ++i) pivot -= row[i] * row[i];
    if (!(pivot > 0)) return false;
    row[j] = std::sqrt(pivot);
  }
  return true;
}

void solve_factorised(const double* l, std::size_t n, double* x) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[n * i + k] * x[k];
    x[i] /= l[n * i + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[n * k + i] * x[k];
    x[i] /= l[n * i + i];
  }
}

CoupledFriction::CoupledFriction(std::size_t n)
    : n_(n), direction_(n), factor_(n * n), x_(n), minimum_(n) {
  moving_.reserve(n);
}

bool CoupledFriction::solve(const double* a, const double* b, const Law* laws, double* x) {
  std::fill(direction_.begin(), direction_.end(), 0);
  std::fill(x_.begin(), x_.end(), 0.0);
  for (std::size_t pattern = 0; pattern < most_patterns(n_); ++pattern) {
    if (!find_minimum(a, b, laws)) return false;
    if (approach(laws) && !release(a, b, laws)) break;
  }
  std::copy(x_.begin(), x_.end(), x);
  return true;
}

bool CoupledFriction::find_minimum(const double* a, const double* b, const Law* laws) {
  moving_.clear();
  for (std::size_t k = 0; k < n_; ++k)
    if (!laws[k].is_dry || direction_[k] != 0) moving_.push_back(k);
  const std::size_t n = moving_.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = moving_[i];
    for (std::size_t j = 0; j <= i; ++j) factor_[n * i + j] = a[n_ * k + moving_[j]];
    minimum_[i] = b[k] - (direction_[k] > 0 ? laws[k].up : direction_[k] < 0 ? -laws[k].down : 0);
  }
  if (!factorise(factor_.data(), n)) return false;
  solve_factorised(factor_.data(), n, minimum_.data());
  return true;
}

bool CoupledFriction::approach(const Law* laws) {
  double way = 1;
  std::size_t stops = n_;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const std::size_t k = moving_[i];
    if (!laws[k].is_dry || minimum_[i] * direction_[k] > 0) continue;
    const double until = x_[k] == 0 ? 0 : x_[k] / (x_[k] - minimum_[i]);
    if (until < way || stops == n_) stops = k;
    way = std::min(way, until);
  }
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    double& x = x_[moving_[i]];
    x = way < 1 ? x + way * (minimum_[i] - x) : minimum_[i];
  }
  if (stops == n_) return true;
  x_[stops] = 0;
  direction_[stops] = 0;
  return false;
}

bool CoupledFriction::release(const double* a, const double* b, const Law* laws) {
  double most = 0;
  std::size_t leaves = n_;
  int direction = 0;
  for (std::size_t k = 0; k < n_; ++k) {
    if (!laws[k].is_dry || direction_[k] != 0) continue;
    double held = b[k];
    for (const std::size_t j : moving_) held -= a[n_ * k + j] * x_[j];
    const double excess = held > 0 ? held - laws[k].up : -held - laws[k].down;
    if (excess <= most) continue;
    most = excess;
    leaves = k;
    direction = held > 0 ? 1 : -1;
  }
  if (leaves == n_) return false;
  direction_[leaves] = direction;
  return true;
}

}  // namespace cablefit
