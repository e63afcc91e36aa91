#include "cablefit/elastic/models/held_out.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "cablefit/estimate/solve/constrained_least_squares.hpp"

namespace cablefit {
namespace {

constexpr double kSignificant = 2;  // paired block test, standard errors
constexpr double kWorthwhile =
    0.01;                            // relative gain in mean squared error below which nobody cares
constexpr double kRounding = 1e-14;  // of the largest eigenvalue of a Gram matrix

// Least squares from a Gram matrix with scaled columns: scaled * y = b, x = scale * y. Its
// precision (condition squared) is plenty for comparing models; estimates that are reported come
// from the QR.
struct NormalEquations {
  Eigen::MatrixXd scaled;
  Eigen::VectorXd b, scale;
};

NormalEquations normal_equations(const Eigen::MatrixXd& gram,
                                 const std::vector<Eigen::Index>& regressors,
                                 const Eigen::VectorXd& response) {
  const auto p = static_cast<Eigen::Index>(regressors.size());
  NormalEquations n{Eigen::MatrixXd(p, p), Eigen::VectorXd(p), Eigen::VectorXd(p)};
  for (Eigen::Index i = 0; i < p; ++i) {
    const double norm = std::sqrt(
        gram(regressors[static_cast<std::size_t>(i)], regressors[static_cast<std::size_t>(i)]));
    n.scale(i) = norm > 0 ? 1 / norm : 1;
  }
  for (Eigen::Index i = 0; i < p; ++i) {
    const Eigen::Index ri = regressors[static_cast<std::size_t>(i)];
    n.b(i) = n.scale(i) * gram.row(ri).dot(response);
    for (Eigen::Index j = 0; j < p; ++j)
      n.scaled(i, j) = n.scale(i) * n.scale(j) * gram(ri, regressors[static_cast<std::size_t>(j)]);
  }
  return n;
}

/// |root y - c| differs from the residual by a constant, so constraints can be put on it.
Eigen::VectorXd solve_constrained(const NormalEquations& n, const Eigen::MatrixXd& constraints) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(n.scaled);
  const double smallest = kRounding * eigen.eigenvalues().maxCoeff();
  Eigen::VectorXd root = eigen.eigenvalues(), inverse = root;
  for (Eigen::Index k = 0; k < root.size(); ++k) {
    const bool is_determined = root(k) > smallest;
    root(k) = is_determined ? std::sqrt(root(k)) : 0;
    inverse(k) = is_determined ? 1 / root(k) : 0;
  }
  const Eigen::MatrixXd v = eigen.eigenvectors().transpose();
  return n.scale.cwiseProduct(constrained_least_squares(root.asDiagonal() * v,
                                                        inverse.asDiagonal() * v * n.b,
                                                        constraints * n.scale.asDiagonal())
                                  .x);
}

Eigen::VectorXd solve_gram(const Eigen::MatrixXd& gram, const ElasticCandidate& candidate,
                           const Eigen::VectorXd& response) {
  const NormalEquations n = normal_equations(gram, candidate.regressors, response);
  const Eigen::VectorXd x =
      n.scale.cwiseProduct(n.scaled.completeOrthogonalDecomposition().solve(n.b));
  return breaks_constraints(candidate, x) ? solve_constrained(n, constraint_rows(candidate)) : x;
}

}  // namespace

HeldOut::HeldOut(const RowStatistics& rows)
    : cell_rows_(rows.cell_rows()),
      block_grams_(kHeldOutBlocks, Eigen::MatrixXd::Zero(rows.n_columns(), rows.n_columns())),
      block_rows_(kHeldOutBlocks, 0) {
  if (rows.cells().empty()) return;
  first_id_ = rows.cells().front().id;
  last_id_ = rows.cells().back().id;
  for (const GramCell& cell : rows.cells()) {
    const auto block = static_cast<std::size_t>(block_of(cell.id));
    block_grams_[block] += cell.gram;
    block_rows_[block] += cell.n_rows;
  }
}

Eigen::Index HeldOut::block_of(Eigen::Index cell_id) const {
  const Eigen::Index span = std::max<Eigen::Index>(1, last_id_ - first_id_ + 1);
  return std::clamp<Eigen::Index>((cell_id - first_id_) * kHeldOutBlocks / span, 0,
                                  kHeldOutBlocks - 1);
}

std::vector<Eigen::VectorXd> HeldOut::fits(const ElasticCandidate& candidate,
                                           const Eigen::VectorXd& response) const {
  std::vector<Eigen::VectorXd> result;
  for (Eigen::Index fold = 0; fold < kHeldOutFolds; ++fold) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(response.size(), response.size());
    for (Eigen::Index block = 0; block < kHeldOutBlocks; ++block)
      if (block % kHeldOutFolds != fold) gram += block_grams_[static_cast<std::size_t>(block)];
    const Eigen::VectorXd x = solve_gram(gram, candidate, response);
    Eigen::VectorXd residual = response;
    for (std::size_t k = 0; k < candidate.regressors.size(); ++k)
      residual(candidate.regressors[k]) -= x(static_cast<Eigen::Index>(k));
    result.push_back(residual);
  }
  return result;
}

Eigen::VectorXd HeldOut::block_errors(const std::vector<Eigen::VectorXd>& fits) const {
  std::vector<double> errors;
  for (Eigen::Index block = 0; block < kHeldOutBlocks; ++block) {
    const auto k = static_cast<std::size_t>(block);
    if (block_rows_[k] == 0) continue;
    const Eigen::VectorXd& v = fits[static_cast<std::size_t>(block % kHeldOutFolds)];
    errors.push_back(std::max(0.0, v.dot(block_grams_[k] * v)) /
                     static_cast<double>(block_rows_[k]));
  }
  return Eigen::Map<Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
}

bool beats(const Eigen::VectorXd& high, const Eigen::VectorXd& low) {
  const Eigen::ArrayXd gain = (low - high).array();
  const double n = static_cast<double>(gain.size());
  const double mean = gain.mean();
  const double spread = std::sqrt((gain - mean).square().sum() / std::max(1.0, n - 1) / n);
  return n >= 4 && mean > kSignificant * spread && mean > kWorthwhile * low.mean();
}

}  // namespace cablefit
