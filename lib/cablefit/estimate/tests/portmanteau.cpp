#include "cablefit/estimate/tests/portmanteau.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/spread/tail_probability.hpp"

namespace cablefit {
namespace {

constexpr double kBlocksPerLag = 5;  // fewer pairs than blocks, and chi-squared is no longer right
constexpr double kSeen = 2;          // sd of a correlation: what stands out of noise

}  // namespace

void Portmanteau::close_block() {
  if (in_block_ != kBlock) return;  // partly dropped: another mean than the whole ones
  const double mean = sum_ / static_cast<double>(kBlock);
  if (n_blocks_ == 0) recent_block_.fill(-1);
  for (std::size_t k = 0; k < recent_.size(); ++k) {
    const Eigen::Index lag = block_ - recent_block_[k];
    if (recent_block_[k] < 0 || lag < 1 || lag > kLags) continue;
    products_[static_cast<std::size_t>(lag - 1)] += mean * recent_[k];
    pairs_[static_cast<std::size_t>(lag - 1)] += 1;
  }
  const auto place = static_cast<std::size_t>(block_ % kLags);
  recent_[place] = mean;
  recent_block_[place] = block_;
  block_squares_ += mean * mean;
  n_blocks_ += 1;
}

void Portmanteau::add(std::span<const Eigen::Index> numbers,
                      const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double value = values(static_cast<Eigen::Index>(i));
    const Eigen::Index block = numbers[i] / kBlock;
    if (block != block_) {
      close_block();
      block_ = block;
      in_block_ = 0;
      sum_ = 0;
    }
    ++in_block_;
    sum_ += value;
    squares_ += value * value;
    ++n_rows_;
  }
}

double Portmanteau::correlation(int lag) const {
  const auto k = static_cast<std::size_t>(lag - 1);
  if (!(pairs_[k] > 0) || !(block_squares_ > 0)) return 0;
  return products_[k] / pairs_[k] / (block_squares_ / n_blocks_);
}

WhitenessTest Portmanteau::result() const {
  Portmanteau done = *this;
  done.close_block();
  WhitenessTest test;
  test.n_rows = n_rows_;
  test.effective_rows = static_cast<double>(n_rows_);
  const int lags = std::min(kLags, static_cast<int>(done.n_blocks_ / kBlocksPerLag));
  if (lags < 1 || !(done.block_squares_ > 0)) return test;
  test.lags = lags;
  double memory = 1;
  bool remembers = true;
  for (int lag = 1; lag <= lags; ++lag) {
    const double pairs = done.pairs_[static_cast<std::size_t>(lag - 1)];
    const double rho = done.correlation(lag);
    // n (n + 2)/(n - lag) with the pairs there are in place of n - lag.
    if (pairs > 0) test.statistic += pairs * (done.n_blocks_ + 2) / done.n_blocks_ * rho * rho;
    remembers = remembers && rho > kSeen / std::sqrt(std::max(1.0, pairs));
    if (remembers) memory += 2 * rho;
  }
  test.p_value = chi_squared_tail(test.statistic, lags);
  const double row_variance = done.squares_ / static_cast<double>(n_rows_);
  const double block_variance = done.block_squares_ / done.n_blocks_;
  const double share = row_variance / (static_cast<double>(kBlock) * block_variance * memory);
  test.effective_rows *= std::min(1.0, share);
  return test;
}

}  // namespace cablefit
