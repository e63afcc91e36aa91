// p-value of a search under the null, from the largest gains of some searches of simulated data.
// Internal to refine/.
#pragma once

#include <cstddef>
#include <vector>

namespace cablefit {

struct ChanceTail {
  double p = 1;
  bool is_fitted = false;  ///< no draw has such a gain: p of a distribution fitted to them
};

/// P(largest gain of a search >= gain) under the null: (1 + count) / (1 + n). Where no draw has
/// such a gain, it is the predictive tail of a Gumbel distribution fitted by moments, never below
/// least_tail(n).
ChanceTail tail_of_largest(const std::vector<double>& largest, double gain);

/// Number of draws before the first decision on whether more are needed.
inline constexpr std::size_t kFirstDraws = 6;

/// The same p-value where the first kFirstDraws draws decided that more were made. It is uniform
/// under the null for any such decision (a sequential test; Besag & Clifford 1991). Where some of
/// the first draws have such a gain, they alone count. Where none has, p is the probability that
/// none of them does and at most the counted number of the others.
ChanceTail tail_of_sequence(const std::vector<double>& largest, double gain);

/// The least p that n draws support: two decades below the least p that they can count, and at
/// least 1e-4.
double least_tail(std::size_t n_draws);

}  // namespace cablefit
