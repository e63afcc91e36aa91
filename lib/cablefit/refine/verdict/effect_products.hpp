// What the effects of the catalogue do to the rows of a design: products of their columns with each
// other and with the base's, from which it follows what is separable. Internal to
// refine/.
#pragma once

#include <vector>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// A row of the catalogue at some of its shapes.
struct Family {
  const Effect* row = nullptr;
  std::vector<Variant> variants;
};
/// All that may be named from this design's rows and has no date.
std::vector<Family> families_of(const Design& design);

/// Products of everything that was seen, so that runs add up.
struct Products {
  std::vector<Eigen::Index> family;    ///< of each variant
  std::vector<Eigen::Index> first, n;  ///< columns of each variant's span
  std::vector<Eigen::Index> example;   ///< its column
  std::vector<Eigen::VectorXd> scale;  ///< of its columns, the same in all rows
  Eigen::Index n_base = 0;
  double n_rows = 0;  ///< of the design, however few stand for them
  Eigen::MatrixXd gram;
};
/// In units of `floor` (per kind of row). `values`: of the base's columns. `like`: of other rows
/// with the same columns, added; nullptr: none.
Products products_of(const Design& design, const std::vector<Family>& families,
                     const KindLevels& floor, const Eigen::VectorXd& values, const Products* like,
                     int threads);

}  // namespace cablefit
