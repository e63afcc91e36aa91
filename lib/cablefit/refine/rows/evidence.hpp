// How well a design explains the data: block Gram matrices, held-out blocks, the evidence for one
// more column. Gram matrices serve the scan, which compares thousands of small fits. Reported
// values come from a QR of the rows (final_fit.hpp). Internal to refine/.
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

/// Number of blocks with rows.
Eigen::Index count_blocks(const BlockGrams& grams);

/// s, where all blocks are added up: any would do.
inline constexpr double kAnyBlock = 2;

/// Gram matrices of blocks of `block_seconds`. Consecutive rows stay together, because residuals
/// are correlated.
BlockGrams block_grams(const std::vector<StretchRows>& rows, const std::vector<Stretch>& stretches,
                       double block_seconds);

/// For a design's rows.
BlockGrams block_grams(const Design& design, double block_seconds);

/// Adds columns without computing the existing products again.
BlockGrams extended(const BlockGrams& base, const std::vector<StretchRows>& rows,
                    const std::vector<Stretch>& stretches, const VariantColumns& columns,
                    double block_seconds);

/// Replaces some columns, per stretch and kind of row. Only their products are computed.
BlockGrams replaced(const BlockGrams& base, const std::vector<StretchRows>& rows,
                    const std::vector<Stretch>& stretches,
                    const std::vector<std::vector<ReplacedColumns>>& columns, double block_seconds);

/// The columns with these numbers, in this order.
BlockGrams with_columns(const BlockGrams& grams, const std::vector<Eigen::Index>& which);

/// The first n columns, and of the later ones those that the rows separate from all columns before.
/// Their own squared part (of unit norm) is at least `least`.
std::vector<Eigen::Index> determined_columns(const BlockGrams& grams, const KindLevels& levels,
                                             Eigen::Index n, double least = 0);

/// Sum over all blocks and kinds of rows, weighted by 1/level^2 of their kind.
Eigen::MatrixXd weighted_sum(const BlockGrams& grams, const KindLevels& levels);

/// A weighted fit, rows weighted by 1/level^2 of their kind.
struct BlockFit {
  Eigen::VectorXd x;        ///< n_columns
  Eigen::ArrayXd held_out;  ///< per block: squared error when the others predict it
  Eigen::Array<bool, Eigen::Dynamic, 1> alone;  ///< blocks that the others cannot predict; 0 there
  Eigen::ArrayXd in_sample;                     ///< per block
  std::array<double, kRowKinds> squares{};      ///< sum of squared residuals, (N m)^2
  std::array<double, kRowKinds> n_rows{};
  std::array<double, kRowKinds> held_out_rows{};  ///< rows in held_out
  Eigen::MatrixXd covariance;                     ///< of x, sandwich over the blocks
  KindLevels rms() const;
  /// Sum of held_out; infinite where the others cannot predict a block that they could in `base`.
  double held_out_error(const BlockFit& base) const;
};

/// Each of the last `n_last` columns must have a squared part of its own of at least `least` (of
/// unit norm) beyond all columns before it. The other columns must only be independent.
struct OwnPart {
  double least = 0;
  Eigen::Index n_last = 0;
};

/// None where the columns are not separable.
std::optional<BlockFit> fit_blocks(const BlockGrams& grams, const KindLevels& levels,
                                   bool with_held_out = true, const OwnPart& own = {});

/// x of a fit without each block in turn. Nothing where the block has no rows, or where the others
/// do not determine all columns.
std::vector<std::optional<Eigen::VectorXd>> values_without_each(const BlockGrams& grams,
                                                                const KindLevels& levels);

/// Covariance of x by leaving out each block in turn. It includes the influence of every single
/// block (jackknife; Efron & Stein 1981: on average not too small). Nothing where the remaining
/// blocks do not determine all columns.
std::optional<Eigen::MatrixXd> jackknife_covariance(const BlockGrams& grams,
                                                    const KindLevels& levels);

/// Weighted squared error of given values.
double error_of(const BlockGrams::Block& block, const KindLevels& levels, const Eigen::VectorXd& x);
/// As above, per block.
Eigen::ArrayXd errors_of(const BlockGrams& grams, const KindLevels& levels,
                         const Eigen::VectorXd& x);
/// Unweighted rms, per kind.
KindLevels rms_of(const BlockGrams& grams, const Eigen::VectorXd& x);

}  // namespace cablefit
