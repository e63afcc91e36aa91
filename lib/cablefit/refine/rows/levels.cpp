#include "cablefit/refine/rows/levels.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/random.hpp"

namespace cablefit {

KindLevels positive(KindLevels levels) {
  for (double& level : levels)
    if (!(level > 0)) level = 1;
  return levels;
}

KindLevels at_least(KindLevels levels, const KindLevels& floor) {
  for (std::size_t k = 0; k < kRowKinds; ++k) levels[k] = std::max(levels[k], floor[k]);
  return levels;
}

KindLevels rms_over(const std::vector<KindLevels>& several) {
  KindLevels out{};
  for (const KindLevels& one : several)
    for (std::size_t k = 0; k < kRowKinds; ++k)
      out[k] += one[k] * one[k] / static_cast<double>(several.size());
  for (double& level : out) level = std::sqrt(level);
  return out;
}

Paired paired(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const Eigen::ArrayXd d = a - b;
  const auto n = static_cast<double>(d.size());
  const double sum = d.sum();
  const double variance = (d - sum / n).square().sum() * n / std::max(1.0, n - 1);
  return {sum, std::sqrt(variance)};
}

double rho_of(const BlockFit& fit, const KindLevels& floor) {
  double sum = 0, n = 0;
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    sum += fit.squares[k] / (floor[k] * floor[k]);
    n += fit.n_rows[k];
  }
  return n > 0 ? sum / n : 0;
}

double RowGap::quantile(double level, std::uint64_t seed) const {
  constexpr int kResamples = 400;
  Random random(seed, 31);
  std::vector<double> rhos;
  const Eigen::Index n = squares.size();
  for (int i = 0; i < kResamples; ++i) {
    double sum = 0, rows = 0;
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto b = static_cast<Eigen::Index>(random.uniform() * static_cast<double>(n));
      sum += squares(b);
      rows += n_rows(b);
    }
    if (rows > 0) rhos.push_back(sum / rows);
  }
  if (rhos.empty()) return 0;
  std::sort(rhos.begin(), rhos.end());
  return rhos[static_cast<std::size_t>(level * static_cast<double>(rhos.size() - 1))];
}

RowGap gap_of(const Design& design, const Eigen::VectorXd& x, const KindLevels& floor,
              double block_seconds) {
  return gap_of(block_grams(design, block_seconds), x, floor);
}

RowGap gap_of(BlockGrams grams, const Eigen::VectorXd& x, const KindLevels& floor) {
  std::erase_if(grams.blocks, [](const BlockGrams::Block& block) {
    return std::all_of(block.n_rows.begin(), block.n_rows.end(),
                       [](Eigen::Index n) { return n == 0; });
  });
  RowGap gap;
  gap.squares = errors_of(grams, floor, x);
  gap.n_rows = Eigen::ArrayXd::Zero(gap.squares.size());
  for (std::size_t b = 0; b < grams.blocks.size(); ++b)
    for (const Eigen::Index n : grams.blocks[b].n_rows)
      gap.n_rows(static_cast<Eigen::Index>(b)) += static_cast<double>(n);
  const double rows = gap.n_rows.sum();
  gap.rho = rows > 0 ? gap.squares.sum() / rows : 0;
  return gap;
}

RowGap held_out_gap(const BlockGrams& grams, const KindLevels& levels, const KindLevels& floor) {
  const auto values = values_without_each(grams, levels);
  const auto n = static_cast<Eigen::Index>(values.size());
  RowGap gap{0, Eigen::ArrayXd::Zero(n), Eigen::ArrayXd::Zero(n)};
  for (std::size_t b = 0; b < values.size(); ++b) {
    if (!values[b]) continue;
    const auto at = static_cast<Eigen::Index>(b);
    gap.squares(at) = error_of(grams.blocks[b], floor, *values[b]);
    for (const Eigen::Index rows : grams.blocks[b].n_rows)
      gap.n_rows(at) += static_cast<double>(rows);
  }
  const double rows = gap.n_rows.sum();
  gap.rho = rows > 0 ? gap.squares.sum() / rows : 0;
  return gap;
}

double floor_error(const BlockFit& fit, const KindLevels& floor, const KindLevels& levels) {
  double sum = 0;
  for (std::size_t k = 0; k < kRowKinds; ++k)
    sum += fit.held_out_rows[k] * floor[k] * floor[k] / (levels[k] * levels[k]);
  return sum;
}

}  // namespace cablefit
