#include "cablefit/estimate/solve/constrained_least_squares.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cablefit {
namespace {

// A dual that is this small against |column| |b| is rounding: a few dozen sums of products.
constexpr double kDualTolerance = 1e-13;

/// Columns of unit norm; zero ones stay.
Eigen::VectorXd unit_columns(Eigen::MatrixXd& a) {
  Eigen::VectorXd norm = a.colwise().norm();
  for (double& n : norm)
    if (!(n > 0)) n = 1;
  a = a * norm.cwiseInverse().asDiagonal();
  return norm;
}

/// Least squares on the columns of the set, 0 elsewhere.
Eigen::VectorXd solve_on(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                         const std::vector<Eigen::Index>& set) {
  Eigen::MatrixXd part(a.rows(), static_cast<Eigen::Index>(set.size()));
  for (std::size_t k = 0; k < set.size(); ++k)
    part.col(static_cast<Eigen::Index>(k)) = a.col(set[k]);
  const Eigen::VectorXd z = part.colPivHouseholderQr().solve(b);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(a.cols());
  for (std::size_t k = 0; k < set.size(); ++k) u(set[k]) = z(static_cast<Eigen::Index>(k));
  return u;
}

/// Lawson & Hanson's inner loop: walks from u, feasible on the set, towards the set's least squares
/// solution, and drops what reaches 0 on the way.
Eigen::VectorXd walk(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, Eigen::VectorXd u,
                     std::vector<Eigen::Index>& set) {
  while (!set.empty()) {
    const Eigen::VectorXd z = solve_on(a, b, set);
    double step = 1;
    Eigen::Index first = -1;  // to reach 0
    for (const Eigen::Index k : set)
      if (z(k) <= 0 && (first < 0 || u(k) / (u(k) - z(k)) < step)) {
        step = u(k) / (u(k) - z(k));
        first = k;
      }
    if (first < 0) return z;
    u += step * (z - u);
    u(first) = 0;
    std::erase_if(set, [&](Eigen::Index k) { return u(k) <= 0; });
    for (Eigen::Index k = 0; k < u.size(); ++k)
      if (std::find(set.begin(), set.end(), k) == set.end()) u(k) = 0;
  }
  return Eigen::VectorXd::Zero(a.cols());
}

/// The column outside the set along which |a u - b| falls fastest; -1 when there is none.
Eigen::Index steepest(const Eigen::VectorXd& dual, const std::vector<Eigen::Index>& set,
                      const std::vector<bool>& refused, double tolerance) {
  Eigen::Index best = -1;
  for (Eigen::Index k = 0; k < dual.size(); ++k) {
    if (refused[static_cast<std::size_t>(k)] || !(dual(k) > tolerance)) continue;
    if (std::find(set.begin(), set.end(), k) != set.end()) continue;
    if (best < 0 || dual(k) > dual(best)) best = k;
  }
  return best;
}

/// Coordinates in which |a x - b| is a distance: x = half w, w = c at the minimum.
struct Whitened {
  Eigen::MatrixXd half;
  Eigen::VectorXd c;
};

Whitened whiten(Eigen::MatrixXd a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd norm = unit_columns(a);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& sv = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < sv.size() && sv(rank) > kRankTolerance * sv(0)) ++rank;
  return {norm.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(rank) *
              sv.head(rank).cwiseInverse().asDiagonal(),
          svd.matrixU().leftCols(rank).transpose() * b};
}

}  // namespace

Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& columns,
                                           const Eigen::VectorXd& b) {
  Eigen::MatrixXd a = columns;
  const Eigen::VectorXd norm = unit_columns(a);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(a.cols());
  std::vector<Eigen::Index> set;  // of positive u
  std::vector<bool> refused(static_cast<std::size_t>(a.cols()), false);
  double distance = b.norm();
  const double tolerance = kDualTolerance * distance;
  for (;;) {
    const Eigen::Index next = steepest(a.transpose() * (b - a * u), set, refused, tolerance);
    if (next < 0) return u.cwiseQuotient(norm);
    std::vector<Eigen::Index> larger = set;
    larger.push_back(next);
    const Eigen::VectorXd better = walk(a, b, u, larger);
    const double left = (a * better - b).norm();
    // In exact arithmetic it always falls. Where rounding says no, the column stays out.
    if (!(left < distance)) {
      refused[static_cast<std::size_t>(next)] = true;
      continue;
    }
    u = better;
    set = larger;
    distance = left;
    std::fill(refused.begin(), refused.end(), false);
  }
}

ConstrainedSolution constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                              const Eigen::MatrixXd& g) {
  ConstrainedSolution solution;
  const Whitened white = whiten(a, b);
  solution.multipliers = Eigen::VectorXd::Zero(g.rows());
  solution.x = white.half * white.c;
  if (g.rows() == 0 || (g * solution.x).minCoeff() >= 0) return solution;
  const Eigen::MatrixXd normals = (g * white.half).transpose();
  solution.multipliers = non_negative_least_squares(normals, -white.c);
  solution.x = white.half * (white.c + normals * solution.multipliers);
  for (Eigen::Index i = 0; i < g.rows(); ++i)
    if (solution.multipliers(i) > 0) solution.active.push_back(i);
  return solution;
}

}  // namespace cablefit
