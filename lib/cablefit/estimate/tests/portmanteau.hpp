// Is a residual white? Ljung & Box 1978, on a series with holes whose rows a low-pass has coloured.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

namespace cablefit {

struct WhitenessTest {
  double statistic = 0;  ///< Ljung & Box's Q
  int lags = 0;          ///< its degrees of freedom
  double p_value = 1;    ///< 1 when there are too few rows to say
  /// How many independent values the mean of the rows is worth, at most n_rows.
  double effective_rows = 0;
  std::size_t n_rows = 0;

  bool is_possible() const { return lags > 0; }
};

/// Takes means over blocks of kBlock places of the time grid: rows at 2.5 per period of the cut-off
/// are correlated by the filter alone (0.23 at lag 1), their block means are not, since the
/// filter is flat where they have their power. What is left is the residual's own memory.
class Portmanteau {
 public:
  static constexpr Eigen::Index kBlock = 4;
  static constexpr int kLags = 20;

  /// Consecutive rows: `numbers` their places on the time grid, growing; values NaN are not
  /// allowed.
  void add(std::span<const Eigen::Index> numbers, const Eigen::Ref<const Eigen::VectorXd>& values);

  WhitenessTest result() const;

 private:
  void close_block();
  double correlation(int lag) const;

  Eigen::Index block_ = -1, in_block_ = 0;
  double sum_ = 0;
  // Means of the last blocks by number, 0 where a block is not whole.
  std::array<double, kLags> recent_{};
  std::array<Eigen::Index, kLags> recent_block_{};
  std::array<double, kLags> products_{};
  std::array<double, kLags> pairs_{};
  double block_squares_ = 0, n_blocks_ = 0, squares_ = 0;
  std::size_t n_rows_ = 0;
};

}  // namespace cablefit
