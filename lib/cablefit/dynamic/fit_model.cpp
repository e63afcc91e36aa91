#include "cablefit/dynamic/fit_model.hpp"

#include <algorithm>

#include "cablefit/model/assembled_model.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"

namespace cablefit {
namespace {

FindEstimate finder(const std::vector<Estimate>& parameters) {
  return [&parameters](const Estimate& blank) -> std::optional<Estimate> {
    const Estimate* found = find_estimate(parameters, blank.name);
    if (found == nullptr) return std::nullopt;
    Estimate e = *found;
    e.symbol = blank.symbol;
    e.unit = blank.unit;
    return e;
  };
}

/// The coefficients and elongations, and what stage 1 found besides.
std::vector<Estimate> elastic_of(const ElasticFit& fit, const Rig& rig) {
  std::vector<Estimate> elastic = elastic_estimates(fit.transmission, rig, finder(fit.parameters));
  for (const Estimate& e : fit.parameters) {
    if (find_estimate(elastic, e.name) != nullptr) continue;
    elastic.push_back(e);
    elastic.back().symbol = e.name;
  }
  return elastic;
}

std::vector<WindowMean> link_residual(const DynamicPreload& preload, const std::string& model) {
  const auto link = std::find_if(preload.residual_tests.begin(), preload.residual_tests.end(),
                                 [&](const JudgedEquation& e) {
                                   return e.model == model && e.equation == to_string(Side::link);
                                 });
  return link == preload.residual_tests.end() ? std::vector<WindowMean>{} : link->means;
}

}  // namespace

Model model_of(const DynamicFit& fit, const DynamicPreload& preload, const Rig& rig) {
  Model model = assembled_model(rig, !fit.elastic, finder(fit.parameters));
  model.name = fit.model;
  model.preload = preload.name;
  set_added_effects(fit.effects, model);
  model.covariance = fit.covariance;
  model.link_residual = link_residual(preload, fit.model);
  if (!fit.elastic) return model;
  model.transmission = fit.elastic->transmission;
  model.elastic = elastic_of(*fit.elastic, rig);
  return model;
}

}  // namespace cablefit
