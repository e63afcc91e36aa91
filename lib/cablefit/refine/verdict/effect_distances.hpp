// Distances between effects, in the rows of their products. Internal to refine/.
#pragma once

#include "cablefit/refine/verdict/effect_products.hpp"

namespace cablefit {

/// Effects by their number among `families`. `products`: outlives this.
class Distances {
 public:
  Distances(const Products& products, const std::vector<Family>& families);

  bool is_there(std::size_t f) const { return !own_[f].empty(); }

  /// Share of an effect's square that the base does not explain, for its most visible shape.
  double from_base(std::size_t f) const;

  /// Share that no shape of one effect explains of the other effect's part beyond the base. An
  /// explanation with more parameters that is no better does not count.
  double between(std::size_t a, std::size_t b) const;

 private:
  double one_way(std::size_t truth, std::size_t other) const;

  const Products& p_;
  Eigen::MatrixXd left_;
  std::vector<std::size_t> n_parameters_;
  std::vector<std::vector<std::size_t>> own_;
  std::vector<Eigen::MatrixXd> inverses_;
};

}  // namespace cablefit
