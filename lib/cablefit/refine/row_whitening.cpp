#include "cablefit/refine/row_whitening.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

// More predicts a wandering torque behind white noise no better.
constexpr Eigen::Index kOrder = 12;

/// Rows [from, to) each of which comes right after the other.
struct Run {
  Eigen::Index from = 0, to = 0;
};

std::vector<Run> runs_of(const std::vector<Eigen::Index>& at, Eigen::Index stride,
                         double samples_per_block) {
  const auto block_of = [&](Eigen::Index sample) {
    return static_cast<Eigen::Index>(static_cast<double>(sample) / samples_per_block);
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const bool goes_on =
        i > 0 && at[i] - at[i - 1] == stride && block_of(at[i]) == block_of(at[i - 1]);
    if (!goes_on) runs.push_back({row, row});
    runs.back().to = row + 1;
  }
  return runs;
}

}  // namespace

RowWhitening::RowWhitening(const std::array<Eigen::VectorXd, kRowKinds>& autocovariance,
                           double block_seconds)
    : block_seconds_(block_seconds) {
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    const Eigen::VectorXd& covariance = autocovariance[k];
    if (covariance.size() < 2 || !(covariance(0) > 0)) continue;
    // Levinson 1946, Durbin 1960: each order's prediction from that of the order before.
    std::vector<double> left = {covariance(0)};
    std::vector<Prediction>& of_kind = predictions_[k];
    of_kind.emplace_back();
    for (Eigen::Index order = 1; order <= std::min(kOrder, covariance.size() - 1); ++order) {
      const Eigen::VectorXd& last = of_kind.back().from;
      const double partial =
          (covariance(order) - last.dot(covariance.segment(1, order - 1).reverse())) / left.back();
      if (!(std::abs(partial) < 1)) break;
      Prediction next;
      next.from.resize(order);
      next.from.head(order - 1) = last - partial * last.reverse();
      next.from(order - 1) = partial;
      of_kind.push_back(std::move(next));
      left.push_back(left.back() * (1 - partial * partial));
    }
    for (std::size_t order = 0; order < of_kind.size(); ++order)
      of_kind[order].weight = std::sqrt(left.back() / left[order]);
  }
}

bool RowWhitening::is_needed() const {
  return std::any_of(predictions_.begin(), predictions_.end(),
                     [](const auto& of_kind) { return !of_kind.empty(); });
}

Eigen::MatrixXd RowWhitening::of(const KindRows& rows, const Smoothing& smoothing,
                                 const Eigen::MatrixXd& columns) const {
  const std::vector<Prediction>& of_kind = predictions_[static_cast<std::size_t>(rows.kind)];
  if (of_kind.empty()) return columns;
  const auto longest = static_cast<Eigen::Index>(of_kind.size()) - 1;
  Eigen::MatrixXd out = columns;
  for (const Run& run : runs_of(rows.at, smoothing.stride, block_seconds_ / smoothing.period)) {
    const Eigen::Index full = std::min(run.from + longest, run.to);
    const auto leave_unpredicted = [&](Eigen::Index from, Eigen::Index n, const Prediction& p) {
      for (Eigen::Index lag = 1; lag <= p.from.size(); ++lag)
        out.middleRows(from, n) -= p.from(lag - 1) * columns.middleRows(from - lag, n);
      out.middleRows(from, n) *= p.weight;
    };
    for (Eigen::Index row = run.from; row < full; ++row)
      leave_unpredicted(row, 1, of_kind[static_cast<std::size_t>(row - run.from)]);
    if (full < run.to) leave_unpredicted(full, run.to - full, of_kind.back());
  }
  return out;
}

}  // namespace cablefit
