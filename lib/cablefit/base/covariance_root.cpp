#include "cablefit/base/covariance_root.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace cablefit {

Eigen::MatrixXd covariance_root(const Eigen::MatrixXd& a) {
  constexpr double kRounding = 1e-12;  // of eigenvalues where the diagonal is 1
  if (a.size() == 0) return a;
  const Eigen::VectorXd scale =
      a.diagonal().unaryExpr([](double x) { return x > 0 ? std::sqrt(x) : 1.0; });
  const Eigen::VectorXd over = scale.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(over.asDiagonal() * a *
                                                             over.asDiagonal());
  const Eigen::VectorXd lengths =
      eigen.eigenvalues().unaryExpr([](double x) { return x > kRounding ? std::sqrt(x) : 0.0; });
  return scale.asDiagonal() * eigen.eigenvectors() * lengths.asDiagonal();
}

}  // namespace cablefit
