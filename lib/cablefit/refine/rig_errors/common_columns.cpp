#include "cablefit/refine/rig_errors/common_columns.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace cablefit {
namespace {

/// Combinations of all columns: each of the last ones, minus what the first n stand for.
Eigen::MatrixXd own_parts(const Eigen::MatrixXd& all, Eigen::Index n) {
  const Eigen::Index n_last = all.cols() - n;
  const Eigen::VectorXd scale = all.diagonal().unaryExpr(
      [](double square) { return square > 0 ? 1 / std::sqrt(square) : 1.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * all * scale.asDiagonal();
  Eigen::MatrixXd own(n + n_last, n_last);
  own.topRows(n) = -scaled.topLeftCorner(n, n).ldlt().solve(scaled.topRightCorner(n, n_last));
  own.bottomRows(n_last).setIdentity();
  return scale.asDiagonal() * own * scale.tail(n_last).cwiseInverse().asDiagonal();
}

}  // namespace

CommonColumns::CommonColumns(Eigen::Index n_values)
    : matrix_(Eigen::MatrixXd::Zero(n_values, n_values)),
      squares_(Eigen::VectorXd::Zero(n_values)) {}

void CommonColumns::add_joint(const BlockGrams& grams, const KindLevels& levels,
                              const Eigen::VectorXd& x) {
  const Eigen::Index n = x.size(), n_values = squares_.size();
  const Eigen::MatrixXd all =
      weighted_sum(grams, levels).bottomRightCorner(n + n_values, n + n_values);
  const Eigen::MatrixXd own = own_parts(all, n);
  matrix_ += own.transpose() * all * own;
  squares_ += all.diagonal().tail(n_values);
  Eigen::VectorXd residual(1 + n + n_values);  // response minus columns
  residual << 1, -x, Eigen::VectorXd::Zero(n_values);
  for (const BlockGrams::Block& block : grams.blocks) {
    Block& sum = blocks_.emplace_back(
        Block{Eigen::VectorXd::Zero(n_values), Eigen::VectorXd::Zero(n_values)});
    for (std::size_t kind = 0; kind < block.gram.size(); ++kind) {
      const Eigen::MatrixXd& gram = block.gram[kind];
      if (gram.size() == 0) continue;
      const double weight = 1 / (levels[kind] * levels[kind]);
      sum.right += weight * (own.transpose() * (gram.bottomRows(n + n_values) * residual));
      sum.squares += weight * gram.diagonal().tail(n_values);
    }
  }
}

Eigen::VectorXd CommonColumns::most_shown() const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(matrix_);
  return parts.eigenvectors().rightCols(1);
}

std::optional<CommonStep> CommonColumns::step(const std::vector<Eigen::Index>& of,
                                              double least_own) const {
  const auto n = static_cast<Eigen::Index>(of.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(matrix_(of, of));
  if (!(parts.eigenvalues()(0) > least_own * squares_(of).sum())) return {};
  const Eigen::MatrixXd inverse = parts.eigenvectors() *
                                  parts.eigenvalues().cwiseInverse().asDiagonal() *
                                  parts.eigenvectors().transpose();
  CommonStep step;
  step.n_blocks = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(n, n);
  for (const Block& block : blocks_) {
    const Eigen::VectorXd own = block.right(of);
    right += own;
    scatter += own * own.transpose();
    step.n_blocks += (block.squares(of).array() > 0).cast<double>().matrix();
  }
  step.change = inverse * right;
  step.covariance = inverse * scatter * inverse;
  step.fall = right.dot(step.change);
  if (!step.change.allFinite() || !(step.n_blocks.minCoeff() > static_cast<double>(n))) return {};
  return step;
}

}  // namespace cablefit
