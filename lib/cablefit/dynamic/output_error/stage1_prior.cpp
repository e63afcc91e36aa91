#include "cablefit/dynamic/output_error/stage1_prior.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

// Constraints that hold a cable's law make some direction of its coefficients exact: so little of
// each variance is taken for unknown that the covariance has an inverse.
constexpr double kRidge = 1e-9;

bool is_elastic(const ModelParameter& p) {
  return p.kind == ParameterKind::stiffness || p.kind == ParameterKind::coefficient;
}

/// In the order of stage 1's covariance (elastic_coefficients()).
std::vector<ModelParameter> coefficients_of(const Model& model) {
  std::vector<ModelParameter> all = model_parameters(model);
  std::erase_if(all, [](const ModelParameter& p) { return !is_elastic(p); });
  return all;
}

Eigen::Index place_of(const std::vector<Estimate>& estimates, const std::string& name) {
  const auto found = std::find_if(estimates.begin(), estimates.end(),
                                  [&](const Estimate& e) { return e.name == name; });
  return found == estimates.end() ? -1 : found - estimates.begin();
}

void take_estimate(const Estimate& from, bool robust, Estimate& to) {
  const double cad = to.cad;
  const std::string unit = to.unit;
  to = from;
  to.unit = unit;
  to.cad = cad;
  if (!robust) to.sd = to.sd_white;
}

}  // namespace

Stage1Prior stage1_prior(const Model& model, const ElasticFit& stage1) {
  Stage1Prior out;
  const std::vector<ModelParameter> coefficients = coefficients_of(model);
  const auto n = static_cast<Eigen::Index>(coefficients.size());
  std::vector<Eigen::Index> known;
  for (Eigen::Index k = 0; k < n; ++k) {
    const ModelParameter& p = coefficients[static_cast<std::size_t>(k)];
    const bool has_sd = stage1.covariance.rows() == n && stage1.covariance(k, k) > 0;
    if (!has_sd) {
      out.held.push_back(p.name);
      continue;
    }
    known.push_back(k);
    out.prior.names.push_back(p.name);
  }
  const auto n_known = static_cast<Eigen::Index>(known.size());
  out.prior.mean.resize(n_known);
  for (Eigen::Index k = 0; k < n_known; ++k)
    out.prior.mean[k] = parameter_value(
        model, coefficients[static_cast<std::size_t>(known[static_cast<std::size_t>(k)])]);
  if (n_known > 0) out.prior.covariance = stage1.covariance(known, known);
  out.prior.covariance.diagonal() *= 1 + kRidge;
  return out;
}

ElasticFit refined_stage1(const ElasticFit& stage1, const OutputErrorFit& fit, bool robust) {
  ElasticFit refined = stage1;
  refined.transmission = fit.model.transmission;
  for (Estimate& e : refined.parameters) {
    const Estimate* found = find_estimate(fit.parameters, e.name);
    if (found == nullptr || !found->not_identifiable.empty()) continue;
    if (e.not_identifiable.empty()) take_estimate(*found, robust, e);
  }
  const std::vector<ModelParameter> coefficients = coefficients_of(fit.model);
  const Eigen::MatrixXd& covariance = robust ? fit.covariance : fit.covariance_white;
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    for (std::size_t j = 0; j < coefficients.size(); ++j) {
      const Eigen::Index a = place_of(fit.parameters, coefficients[i].name),
                         b = place_of(fit.parameters, coefficients[j].name);
      if (a >= 0 && b >= 0)
        refined.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            covariance(a, b);
    }
  return refined;
}

Stage1Shift largest_shift(const GaussianPrior& prior, const OutputErrorFit& fit) {
  Stage1Shift largest;
  for (std::size_t k = 0; k < prior.names.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Estimate* e = find_estimate(fit.parameters, prior.names[k]);
    if (e == nullptr || !std::isfinite(e->value)) continue;
    const double shift = (e->value - prior.mean[i]) / std::sqrt(prior.covariance(i, i));
    if (largest.name.empty() || std::abs(shift) > std::abs(largest.in_sd))
      largest = {prior.names[k], shift, prior.mean[i], e->value};
  }
  return largest;
}

}  // namespace cablefit
