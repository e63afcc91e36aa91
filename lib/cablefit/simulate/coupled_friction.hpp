// Dry friction of links that move each other: which of them stick. Internal to the simulator.
#pragma once

#include <cstddef>
#include <vector>

namespace cablefit {

/// The x that solves A x = b - lambda with lambda_k in level_k Sgn(x_k): up_k where x_k > 0,
/// -down_k where x_k < 0, anything between where x_k = 0. With A positive definite it is the only
/// minimum of
///
///   x' A x / 2 - b' x + sum_k (up_k max(x_k, 0) + down_k max(-x_k, 0)).
///
/// Primal active set (Nocedal & Wright 2006, ch. 16.5): every joint is at rest or moves in one
/// direction. The minimum of a pattern is one Cholesky solution; on the way to it a joint that
/// would change its direction comes to rest. At a minimum the joint whose friction is exceeded most
/// leaves rest. The function falls from minimum to minimum, so no pattern comes twice, and there
/// are finitely many. What rests is exactly 0.
class CoupledFriction {
 public:
  explicit CoupledFriction(std::size_t n);

  /// Per joint: `is_dry`: it has the law above, else it is free (lambda = 0).
  struct Law {
    double up = 0, down = 0;  ///< >= 0
    bool is_dry = false;
  };

  /// `a`: n x n, symmetric, row by row. False, and `x` untouched, where A is not positive definite.
  bool solve(const double* a, const double* b, const Law* laws, double* x);

 private:
  bool find_minimum(const double* a, const double* b, const Law* laws);
  /// Moves towards the minimum; true when it is reached, false when a joint came to rest before.
  bool approach(const Law* laws);
  /// True when a joint left rest.
  bool release(const double* a, const double* b, const Law* laws);

  std::size_t n_;
  std::vector<int> direction_;       ///< per joint: 0 at rest
  std::vector<std::size_t> moving_;  ///< joints of the pattern
  std::vector<double> factor_, x_, minimum_;
};

/// A = L L', in place (the lower triangle, n x n row by row); false: not positive definite.
bool factorise(double* a, std::size_t n);
/// Solves L L' x = b, in place.
void solve_factorised(const double* l, std::size_t n, double* x);

}  // namespace cablefit
