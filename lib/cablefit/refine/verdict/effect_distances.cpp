#include "cablefit/refine/verdict/effect_distances.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

/// Inverse of a Gram matrix over the directions that are there at all.
Eigen::MatrixXd safe_inverse(const Eigen::MatrixXd& gram) {
  constexpr double kThere = 1e-9;
  const Eigen::VectorXd scale =
      gram.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * gram *
                                                             scale.asDiagonal());
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([](double value) { return value > kThere ? 1 / value : 0.0; });
  return scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
         eigen.eigenvectors().transpose() * scale.asDiagonal();
}
}  // namespace

Distances::Distances(const Products& products, const std::vector<Family>& families) : p_(products) {
  for (const Family& family : families) n_parameters_.push_back(family.row->parameters.size());
  const Eigen::Index b = p_.n_base, rest = p_.gram.cols() - b;
  const Eigen::MatrixXd inverse = safe_inverse(p_.gram.topLeftCorner(b, b));
  left_ = p_.gram.bottomRightCorner(rest, rest) -
          p_.gram.bottomLeftCorner(rest, b) * inverse * p_.gram.topRightCorner(b, rest);
  own_.resize(families.size());
  for (std::size_t v = 0; v < p_.family.size(); ++v)
    own_[static_cast<std::size_t>(p_.family[v])].push_back(v);
  for (std::size_t v = 0; v < p_.family.size(); ++v)
    inverses_.push_back(
        safe_inverse(left_.block(p_.first[v] - b, p_.first[v] - b, p_.n[v], p_.n[v])));
}

double Distances::from_base(std::size_t f) const {
  double most = 0;
  for (const std::size_t v : own_[f]) {
    const Eigen::Index e = p_.example[v];
    const double all = p_.gram(e, e);
    if (all > 0) most = std::max(most, left_(e - p_.n_base, e - p_.n_base) / all);
  }
  return most;
}

double Distances::between(std::size_t a, std::size_t b) const {
  double least = 1;
  if (n_parameters_[b] <= n_parameters_[a]) least = std::min(least, one_way(a, b));
  if (n_parameters_[a] <= n_parameters_[b]) least = std::min(least, one_way(b, a));
  return least;
}

double Distances::one_way(std::size_t truth, std::size_t other) const {
  const std::size_t v = own_[truth][own_[truth].size() / 2];
  const Eigen::Index e = p_.example[v] - p_.n_base;
  const double all = left_(e, e);
  if (!(all > 0)) return 0;
  double least = 1;
  for (const std::size_t w : own_[other]) {
    const Eigen::VectorXd products = left_.block(p_.first[w] - p_.n_base, e, p_.n[w], 1);
    least = std::min(least, 1 - products.dot(inverses_[w] * products) / all);
  }
  return std::max(0.0, least);
}

}  // namespace cablefit
