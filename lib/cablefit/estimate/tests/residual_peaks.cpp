#include "cablefit/estimate/tests/residual_peaks.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace cablefit {
namespace {

constexpr std::size_t kKept = 16;  // rows per batch: neighbours of a peak are nearly as large

/// Places of the largest values, and the largest of the others.
struct Top {
  std::vector<Eigen::Index> at;
  double rest = 0;
};

Top find_top(const Eigen::VectorXd& values) {
  std::array<std::pair<double, Eigen::Index>, kKept + 1> best;  // descending
  best.fill({-1, -1});
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!(values(i) > best.back().first)) continue;
    best.back() = {values(i), i};
    for (std::size_t k = kKept; k > 0 && best[k].first > best[k - 1].first; --k)
      std::swap(best[k], best[k - 1]);
  }
  Top top;
  for (std::size_t k = 0; k < kKept && best[k].second >= 0; ++k) top.at.push_back(best[k].second);
  top.rest = std::max(0.0, best.back().first);
  return top;
}

}  // namespace

ResidualPeaks::ResidualPeaks(Eigen::MatrixXd guesses) : guesses_(std::move(guesses)) {}

void ResidualPeaks::add(const Rows& rows) {
  if (rows.rows() == 0 || guesses_.cols() == 0) return;
  Batch batch;
  batch.reach = rows.colwise().lpNorm<Eigen::Infinity>().transpose();
  for (Eigen::Index fit = 0; fit < guesses_.cols(); ++fit) {
    const Top top = find_top((rows * guesses_.col(fit)).cwiseAbs());
    batch.kept.emplace_back(rows(top.at, Eigen::all));
    batch.rest.push_back(top.rest);
  }
  batches_.push_back(std::move(batch));
}

void ResidualPeaks::add(ResidualPeaks&& later) {
  std::move(later.batches_.begin(), later.batches_.end(), std::back_inserter(batches_));
}

std::optional<double> ResidualPeaks::largest(Eigen::Index fit,
                                             const Eigen::VectorXd& combination) const {
  if (guesses_.cols() == 0) return std::nullopt;
  const auto k = static_cast<std::size_t>(fit);
  const Eigen::VectorXd change = (combination - guesses_.col(fit)).cwiseAbs();
  double largest = 0, others = 0;
  for (const Batch& batch : batches_) {
    if (batch.kept[k].rows() > 0)
      largest = std::max(largest, (batch.kept[k] * combination).cwiseAbs().maxCoeff());
    if (batch.rest[k] > 0) others = std::max(others, batch.rest[k] + change.dot(batch.reach));
  }
  if (others > largest) return std::nullopt;
  return largest;
}

}  // namespace cablefit
