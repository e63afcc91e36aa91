#include "cablefit/estimate/solve/scaled_solve.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <limits>

namespace cablefit {

ScaledSolve solve_scaled(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                         double rank_tolerance) {
  const Eigen::Index p = a.cols();
  ScaledSolve s;
  if (p == 0) {  // every parameter stands on its bound
    s.inverse.resize(0, 0);
    return s;
  }
  Eigen::VectorXd norm = a.colwise().norm();
  for (Eigen::Index k = 0; k < p; ++k)
    if (!(norm(k) > 0)) norm(k) = 1;
  const Eigen::MatrixXd scaled = a * norm.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& sv = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < sv.size() && sv(rank) > rank_tolerance * sv(0)) ++rank;
  s.condition_scaled =
      sv(sv.size() - 1) > 0 ? sv(0) / sv(sv.size() - 1) : std::numeric_limits<double>::infinity();
  const Eigen::VectorXd plain = Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
  s.condition =
      plain(p - 1) > 0 ? plain(0) / plain(p - 1) : std::numeric_limits<double>::infinity();
  s.null_directions = svd.matrixV().rightCols(p - rank);
  if (rank == p) {
    // Full rank: backward stable QR; the SVD above only answers how well determined it is.
    s.x = scaled.householderQr().solve(b).cwiseQuotient(norm);
  } else {
    const auto v = svd.matrixV().leftCols(rank);
    const Eigen::VectorXd c = svd.matrixU().leftCols(rank).transpose() * b;
    s.x = (v * c.cwiseQuotient(sv.head(rank))).cwiseQuotient(norm);
  }
  const Eigen::MatrixXd half = norm.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(rank) *
                               sv.head(rank).cwiseInverse().asDiagonal();
  s.inverse = half * half.transpose();
  return s;
}

}  // namespace cablefit
