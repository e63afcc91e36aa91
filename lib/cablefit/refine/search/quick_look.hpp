// Reduction of the squared error by further columns with all parameters refitted, from sums over
// all rows. A row's nonlinear parameters may have hundreds of values, and this selects those that
// are worth a fit block by block. Internal to refine/.
#pragma once

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

class QuickLook {
 public:
  /// `grams`: of the design without further columns. Throws Error(not_identifiable) when it is
  /// singular.
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
  /// With the first `n` of the further columns. Nothing where the own part of one of them (squared,
  /// of unit norm) is below `least`, see OwnPart.
  std::optional<Glance> with(const Products& products, Eigen::Index n, double least) const;

 private:
  const std::vector<StretchRows>& rows_;
  KindLevels levels_;
  Eigen::VectorXd scale_, response_;  ///< of the columns; in the orthonormal base
  Eigen::MatrixXd lower_;             ///< Cholesky factor of the scaled columns' Gram matrix
  double error_ = 0;
};

}  // namespace cablefit
