// How much of the squared error further columns would remove with everything refitted, from sums
// over all rows: of the hundreds of values that a row's nonlinear parameters may have, which is
// worth a fit block by block. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

class QuickLook {
 public:
  /// `grams`: of the design as it is. Throws Error(not_identifiable) when it is singular.
  QuickLook(const Design& design, const BlockGrams& grams, const KindLevels& levels);

  /// Weighted products of further columns C, in sample: [response, base]' C and
  /// C' C.
  struct Products {
    Eigen::MatrixXd cross, own;
  };
  Products products(const std::vector<std::vector<ActiveColumns>>& columns) const;

  struct Glance {
    double error = 0;   ///< weighted and squared, in sample
    Eigen::VectorXd x;  ///< of the further columns
  };
  /// With the first `n` of the further columns. Nothing where less than `least` (squared, of unit
  /// norm) of one of them is its own: see OwnPart.
  std::optional<Glance> with(const Products& products, Eigen::Index n, double least) const;

 private:
  const std::vector<StretchRows>& rows_;
  KindLevels levels_;
  Eigen::VectorXd scale_, response_;  ///< of the columns; in the orthonormal base
  Eigen::MatrixXd lower_;             ///< Cholesky factor of the scaled columns' Gram matrix
  double error_ = 0;
};

}  // namespace cablefit
