// How well a design explains the data: block Gram matrices, held-out blocks, the evidence for one
// more column. Gram matrices serve the scan, where thousands of small fits are compared; the
// values that are reported come from a QR of the rows (final_fit.hpp). Internal to refine/.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// rms per kind of row, N m.
using KindLevels = std::array<double, kRowKinds>;

/// [response, columns]' [response, columns] of each block of time and kind of row.
struct BlockGrams {
  Eigen::Index n_columns = 0;
  struct Block {
    std::array<Eigen::MatrixXd, kRowKinds> gram;  ///< (1 + n_columns)^2; empty: no row of the kind
    std::array<Eigen::Index, kRowKinds> n_rows{};
  };
  std::vector<Block> blocks;
};

/// Those that have rows.
Eigen::Index count_blocks(const BlockGrams& grams);

/// Blocks of `block_seconds`; consecutive rows stay together, as residuals are correlated.
BlockGrams block_grams(const std::vector<StretchRows>& rows, const std::vector<Stretch>& stretches,
                       double block_seconds);

/// Of a design's rows.
BlockGrams block_grams(const Design& design, double block_seconds);

/// The same with columns more, without forming again what is there.
BlockGrams extended(const BlockGrams& base, const std::vector<StretchRows>& rows,
                    const std::vector<Stretch>& stretches, const VariantColumns& columns,
                    double block_seconds);

/// The same with other columns in place of some, per stretch and kind of row: only the products of
/// these are formed.
BlockGrams replaced(const BlockGrams& base, const std::vector<StretchRows>& rows,
                    const std::vector<Stretch>& stretches,
                    const std::vector<std::vector<ReplacedColumns>>& columns, double block_seconds);

/// The columns of these numbers, in this order.
BlockGrams with_columns(const BlockGrams& grams, const std::vector<Eigen::Index>& which);

/// The first n columns, and of those after them the ones that the rows separate from all before,
/// with a squared part of their own (of unit norm) of at least `least`.
std::vector<Eigen::Index> determined_columns(const BlockGrams& grams, const KindLevels& levels,
                                             Eigen::Index n, double least = 0);

/// All blocks and kinds of rows in one, rows weighted by 1/level^2 of their kind.
Eigen::MatrixXd weighted_sum(const BlockGrams& grams, const KindLevels& levels);

/// A weighted fit, rows weighted by 1/level^2 of their kind.
struct BlockFit {
  Eigen::VectorXd x;        ///< n_columns
  Eigen::ArrayXd held_out;  ///< per block: squared error predicted by the others
  Eigen::Array<bool, Eigen::Dynamic, 1> alone;  ///< blocks that the others cannot predict: 0 there
  Eigen::ArrayXd in_sample;                     ///< per block
  std::array<double, kRowKinds> squares{};      ///< sum of squared residuals, (N m)^2
  std::array<double, kRowKinds> n_rows{};
  std::array<double, kRowKinds> held_out_rows{};  ///< those of held_out
  Eigen::MatrixXd covariance;                     ///< of x, sandwich over the blocks
  KindLevels rms() const;
  /// Sum of held_out; infinite where a block is alone that was not in `base`.
  double held_out_error(const BlockFit& base) const;
};

/// The last `n_last` columns have to bring something of their own: the squared part of each (of
/// unit norm) that all before it leave is at least `least`. The others only have to be independent.
struct OwnPart {
  double least = 0;
  Eigen::Index n_last = 0;
};

/// None where the columns are not separable.
std::optional<BlockFit> fit_blocks(const BlockGrams& grams, const KindLevels& levels,
                                   bool with_held_out = true, const OwnPart& own = {});

/// x of a fit without each block in turn; nothing where the block has no rows, or where the others
/// do not determine all columns.
std::vector<std::optional<Eigen::VectorXd>> values_without_each(const BlockGrams& grams,
                                                                const KindLevels& levels);

/// Covariance of x by leaving out each block in turn, which no block can hide that has a pull of
/// its own (jackknife; Efron & Stein 1981: on average not too small). Nothing where the rest of a
/// block does not determine all columns.
std::optional<Eigen::MatrixXd> jackknife_covariance(const BlockGrams& grams,
                                                    const KindLevels& levels);

/// Squared error of given values, weighted.
double error_of(const BlockGrams::Block& block, const KindLevels& levels, const Eigen::VectorXd& x);
/// The same per block.
Eigen::ArrayXd errors_of(const BlockGrams& grams, const KindLevels& levels,
                         const Eigen::VectorXd& x);
/// Unweighted, per kind.
KindLevels rms_of(const BlockGrams& grams, const Eigen::VectorXd& x);

}  // namespace cablefit
