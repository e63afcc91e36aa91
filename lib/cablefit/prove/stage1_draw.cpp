#include "cablefit/prove/stage1_draw.hpp"

#include "cablefit/base/covariance_root.hpp"

namespace cablefit {
namespace {

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
        if (n > 0) add(covariance_root(truth.covariance) * normal, fit.transmission);
      }
  return drawn;
}

}  // namespace cablefit
