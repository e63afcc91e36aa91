#include "cablefit/elastic/curve_of_model.hpp"

#include <cmath>

namespace cablefit {
namespace {

std::vector<std::string> coefficient_names(const Model& model) {
  std::vector<std::string> names;
  const int n = model.rig.n_joints();
  if (model.transmission.cables.empty())
    for (int joint = 1; joint <= n; ++joint) names.push_back(joint_parameter_name("K", joint, n));
  for (const Cable& cable : model.transmission.cables)
    for (int k = 0; k < cable.n_coefficients(); ++k)
      names.push_back(coefficient_name(cable, k, model.rig.cables_given));
  return names;
}

Eigen::MatrixXd covariance_of(const Model& model) {
  const std::vector<std::string> names = coefficient_names(model);
  if (auto found = model.covariance.of(names)) return *std::move(found);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Estimate* e = find_estimate(model.elastic, names[k]);
    if (e != nullptr && std::isfinite(e->sd))
      variance(static_cast<Eigen::Index>(k)) = e->sd * e->sd;
  }
  return variance.asDiagonal();
}

}  // namespace

ElasticResult curve_of(const Model& model) {
  ElasticPreload preload;
  preload.name = model.preload;
  preload.linear_motion = model.rig.linear_motion;
  preload.rig_path = model.rig.path;
  ElasticFit& fit = preload.fits.emplace_back();
  fit.model = model.transmission.cables.empty() ? "linear" : "poly";
  for (const Cable& cable : model.transmission.cables) fit.order = std::max(fit.order, cable.order);
  fit.parameters = model.elastic;
  fit.transmission = model.transmission;
  fit.covariance = covariance_of(model);
  preload.selected = fit.model;
  return {{}, {std::move(preload)}, {}};
}

}  // namespace cablefit
