#include "cablefit/elastic/curve_of_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/model/model_parameters.hpp"

namespace cablefit {
namespace {

Estimate coefficient(const Model& model, std::string name, std::string unit, double value) {
  Estimate e;
  if (const Estimate* found = find_estimate(model.elastic, name)) e = *found;
  e.name = e.symbol = std::move(name);
  e.unit = std::move(unit);
  e.value = value;
  return e;
}

/// Every coefficient, with or without an sd in the model.
std::vector<Estimate> coefficients_of(const Model& model) {
  std::vector<Estimate> all;
  const int n = model.rig.n_joints();
  if (model.transmission.cables.empty())
    for (int joint = 0; joint < n; ++joint)
      all.push_back(coefficient(model, joint_parameter_name("K", joint + 1, n),
                                unit_for(model.rig.axes.of(joint), "N m/rad"),
                                model.transmission.linear_stiffness[joint]));
  const bool cable_space = model.rig.cables_given;
  for (const Cable& cable : model.transmission.cables)
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      const std::string unit = coefficient_unit(*cable.law, k, cable_space);
      all.push_back(coefficient(model, coefficient_name(cable, k, cable_space),
                                unit_for(axes_of(model.rig.axes, cable), unit),
                                cable.coefficients[static_cast<std::size_t>(k)]));
    }
  return all;
}

Eigen::MatrixXd covariance_of(const std::vector<Estimate>& coefficients,
                              const ParameterCovariance& known) {
  std::vector<std::string> names;
  for (const Estimate& e : coefficients) names.push_back(e.name);
  if (auto found = known.of(names)) return *std::move(found);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  for (std::size_t k = 0; k < coefficients.size(); ++k)
    if (const double sd = coefficients[k].sd; std::isfinite(sd))
      variance(static_cast<Eigen::Index>(k)) = sd * sd;
  return variance.asDiagonal();
}

/// What else stage 1 found: l_o, theta_0, offset, f_sm.
void add_others(const Model& model, std::vector<Estimate>& parameters) {
  for (const Estimate& e : model.elastic)
    if (find_estimate(parameters, e.name) == nullptr) parameters.push_back(e);
}

}  // namespace

ElasticResult curve_of(const Model& model) {
  ElasticPreload preload;
  preload.name = model.preload;
  preload.axes = model.rig.axes.all();
  preload.rig_path = model.rig.path;
  ElasticFit& fit = preload.fits.emplace_back();
  fit.model = model.transmission.cables.empty() ? "linear" : "poly";
  for (const Cable& cable : model.transmission.cables) fit.order = std::max(fit.order, cable.order);
  fit.parameters = coefficients_of(model);
  fit.transmission = model.transmission;
  fit.covariance = covariance_of(fit.parameters, model.covariance);
  add_others(model, fit.parameters);
  preload.selected = fit.model;
  if (model.rig.n_joints() > 1)
    for (const std::string& joint : model.rig.joints) preload.joints.emplace_back().name = joint;
  ElasticResult result;
  result.preloads.push_back(std::move(preload));
  return result;
}

}  // namespace cablefit
