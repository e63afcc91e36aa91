#include "cablefit/design/excitation/scaled_solver.hpp"

#include <Eigen/QR>

namespace cablefit {
namespace {

constexpr double kDetermined = 1e-10;  // of columns of unit norm, exact but for rounding

}  // namespace

ScaledSolver::ScaledSolver(const Eigen::MatrixXd& columns, Eigen::Index least_rows)
    : norms_(columns.colwise().norm()) {
  const Eigen::Index n = columns.cols();
  if (columns.rows() <= least_rows * n || !(norms_.minCoeff() > 0)) return;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns * norms_.cwiseInverse().asDiagonal());
  r_ = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  q_ = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), n);
  determined_ = r_.diagonal().cwiseAbs().minCoeff() > kDetermined;
}

Eigen::MatrixXd ScaledSolver::solve(const Eigen::MatrixXd& right) const {
  const Eigen::MatrixXd projected = q_.transpose() * right;
  return norms_.cwiseInverse().asDiagonal() *
         Eigen::MatrixXd(r_.triangularView<Eigen::Upper>().solve(projected));
}

Eigen::VectorXd ScaledSolver::unit_sd() const {
  const Eigen::Index n = norms_.size();
  const Eigen::MatrixXd inverse =
      r_.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
  return inverse.rowwise().norm().cwiseQuotient(norms_);
}

}  // namespace cablefit
