// How likely a search of nothing finds as much, from the largest gains of some such searches.
// Internal to refine/.
#pragma once

#include <cstddef>
#include <vector>

namespace cablefit {

struct ChanceTail {
  double p = 1;
  bool is_fitted = false;  ///< none of the draws came that far: by a distribution fitted to them
};

/// P(largest gain of a search >= gain) where there is nothing: (1 + count) / (1 + n), or the
/// predictive tail of a Gumbel distribution fitted by moments where none of the draws came that
/// far, never below least_tail(n).
ChanceTail tail_of_largest(const std::vector<double>& largest, double gain);

/// Draws before it is first asked whether more are needed.
inline constexpr std::size_t kFirstDraws = 6;

/// The same where more than kFirstDraws were made only because of what those said, so that p is
/// uniform under the null whatever made them be drawn (a sequential test; Besag & Clifford 1991).
/// Where some of the first came that far, they decide. Where none did, p is the probability that
/// none of them does and no more than counted of the others.
ChanceTail tail_of_sequence(const std::vector<double>& largest, double gain);

/// The least p that n draws support: two decades beyond what they can count, and none below 1e-4.
double least_tail(std::size_t n_draws);

}  // namespace cablefit
