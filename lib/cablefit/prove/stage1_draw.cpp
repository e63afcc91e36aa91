#include "cablefit/prove/stage1_draw.hpp"

#include <Eigen/Eigenvalues>

namespace cablefit {
namespace {

/// A root of a covariance, also of one that is only semidefinite.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

void add(const Eigen::VectorXd& error, Transmission& transmission) {
  Eigen::Index next = 0;
  if (transmission.cables.empty()) transmission.linear_stiffness += error;
  for (Cable& cable : transmission.cables)
    for (double& coefficient : cable.coefficients) coefficient += error(next++);
}

}  // namespace

ElasticResult draw_stage1(const ElasticResult& result, const std::string& preload,
                          const ElasticFit& truth, Random& random) {
  ElasticResult drawn = result;
  const Eigen::Index n = truth.covariance.rows();
  Eigen::VectorXd normal(n);
  for (Eigen::Index k = 0; k < n; ++k) normal(k) = random.normal();
  for (ElasticPreload& p : drawn.preloads)
    for (ElasticFit& fit : p.fits)
      if (p.name == preload && fit.model == truth.model) {
        fit = truth;
        if (n > 0) add(root_of(truth.covariance) * normal, fit.transmission);
      }
  return drawn;
}

}  // namespace cablefit
