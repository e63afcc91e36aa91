// Sizes of residuals, per kind of row and all together. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// Levels that are safe divisors: kinds without rows get 1.
KindLevels positive(KindLevels levels);
KindLevels at_least(KindLevels levels, const KindLevels& floor);
/// Root of the mean square over several.
KindLevels rms_over(const std::vector<KindLevels>& several);

/// Difference of two fits' errors over the blocks, and its standard error.
struct Paired {
  double sum = 0, se = 0;
  double in_sd() const { return se > 0 ? sum / se : sum > 0 ? kUnbounded : 0; }
};
Paired paired(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b);

/// rho: mean over all rows of the squared residual over its squared floor.
double rho_of(const BlockFit& fit, const KindLevels& floor);
/// rho of given values on other rows; also per block, for a bootstrap.
struct RowGap {
  double rho = 0;
  Eigen::ArrayXd squares, n_rows;                               ///< per block
  double quantile(double level, std::uint64_t seed = 1) const;  ///< of rho, blocks resampled
};
RowGap gap_of(const Design& design, const Eigen::VectorXd& x, const KindLevels& floor,
              double block_seconds);
RowGap gap_of(BlockGrams grams, const Eigen::VectorXd& x, const KindLevels& floor);

/// For the design's own rows, each block by a fit to the others with the weights of `levels`.
/// Blocks that the others cannot predict count as blocks without rows.
RowGap held_out_gap(const BlockGrams& grams, const KindLevels& levels, const KindLevels& floor);

/// The weighted squared error of this fit from noise alone.
double floor_error(const BlockFit& fit, const KindLevels& floor, const KindLevels& levels);

}  // namespace cablefit
