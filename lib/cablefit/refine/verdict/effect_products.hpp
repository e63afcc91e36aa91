// Products of the columns of the catalogue's effects with each other and with those of the base, in
// the rows of a design. All statements on separability follow from them. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// A row of the catalogue at some of its shapes.
struct Family {
  const Effect* row = nullptr;
  std::vector<Variant> variants;
};
/// All effects without a time that may be identified from this design's rows.
std::vector<Family> families_of(const Design& design);

/// Products over all rows so far, so that those of several runs can be added.
struct Products {
  std::vector<Eigen::Index> family;    ///< of each variant
  std::vector<Eigen::Index> first, n;  ///< columns of each variant's span
  std::vector<Eigen::Index> example;   ///< column of each variant's example
  std::vector<Eigen::VectorXd> scale;  ///< of its columns, the same in all rows
  Eigen::Index n_base = 0;
  double n_rows = 0;  ///< of the design, even where fewer rows were used
  Eigen::MatrixXd gram;
};
/// In units of `floor` (per kind of row). `values`: of the base's columns. `like`: products of
/// other rows with the same columns, which are added; nullptr: none.
Products products_of(const Design& design, const std::vector<Family>& families,
                     const KindLevels& floor, const Eigen::VectorXd& values, const Products* like,
                     int threads);

}  // namespace cablefit
