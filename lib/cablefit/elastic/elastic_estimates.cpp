#include "cablefit/elastic/elastic_estimates.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/estimate/parameter_estimate.hpp"

namespace cablefit {
namespace {

/// On a rotary axis, or in cable space.
std::string unit_of(const Candidate& candidate, std::size_t k, bool cable_space) {
  if (k >= candidate.n_elastic)
    return candidate.names[k] == "theta_0" ? "rad"
           : candidate.names[k] == "f_vm"  ? "N m s/rad"
                                           : "N m";
  std::size_t first = 0;
  for (const Cable& cable : candidate.transmission.cables) {
    const auto n = static_cast<std::size_t>(cable.n_coefficients());
    if (k < first + n) return coefficient_unit(static_cast<int>(k - first), cable_space);
    first += n;
  }
  return "N m/rad";  // no cables: the linear spring
}

/// Linear spring with an arbitrary encoder zero: K phi + c = K (phi - theta_0), theta_0 = -c/K, by
/// the delta method.
Estimate zero_of_line(const LinearSolution& s, Eigen::Index constant, double zero,
                      bool linear_motion, bool honest) {
  const double stiffness = s.x(0);
  const double by_stiffness = s.x(constant) / (stiffness * stiffness);
  const double by_constant = -1 / stiffness;
  const auto sd = [&](const Eigen::MatrixXd& c) {
    return std::sqrt(by_stiffness * by_stiffness * c(0, 0) +
                     by_constant * by_constant * c(constant, constant) +
                     2 * by_stiffness * by_constant * c(0, constant));
  };
  Estimate e;
  e.name = e.symbol = "theta_0";
  e.unit = linear_motion ? "m" : "rad";
  e.value = zero - s.x(constant) / stiffness;
  e.sd_white = sd(s.covariance_white);
  e.sd = honest ? sd(s.covariance) : e.sd_white;
  set_interval(e, s.degrees_of_freedom);
  return e;
}

/// Coefficients of one cable always lean on each other; said once rather than pair by pair.
std::vector<std::string> worth_saying(const std::vector<std::string>& warnings,
                                      const Candidate& candidate) {
  std::vector<std::string> kept;
  if (candidate.model == "linear") return warnings;
  std::size_t between_coefficients = 0;
  for (const std::string& warning : warnings) {
    std::size_t elastic = 0;
    for (std::size_t k = 0; k < candidate.n_elastic; ++k)
      elastic += warning.find(fmt::format("{} ", candidate.names[k])) != std::string::npos;
    if (elastic >= 2) {
      ++between_coefficients;
    } else {
      kept.push_back(warning);
    }
  }
  if (between_coefficients > 0 && candidate.order > 2)
    kept.push_back(
        fmt::format("coefficients of order {} lean on each other: trust the curve, not single "
                    "coefficients",
                    candidate.order));
  return kept;
}

}  // namespace

ElasticFit make_fit(const ElasticJob& job, const Candidate& candidate, const LinearSolution& s,
                    const BlockedRows& rows, const Nuisance& nuisance) {
  const Rig& rig = job.rig();
  const double zero = rows.transmission.theta_0(0);
  const auto n = static_cast<Eigen::Index>(candidate.n_elastic);
  ElasticFit fit;
  fit.model = candidate.model;
  fit.order = candidate.order;
  fit.condition = s.condition_scaled;
  fit.effective_rows = s.effective_rows;
  fit.rms_error = s.rms();
  fit.transmission = fitted_transmission(candidate, s);
  fit.covariance = (job.options.honest_sd ? s.covariance : s.covariance_white).topLeftCorner(n, n);
  fit.warnings = worth_saying(s.warnings, candidate);
  for (std::size_t k = 0; k < candidate.names.size(); ++k) {
    const std::string& name = candidate.names[k];
    if (name == "f_vm") continue;  // a sweep this slow only keeps it out of f_sm
    const auto index = static_cast<Eigen::Index>(k);
    const std::string unit = unit_of(candidate, k, rig.cables_given);
    Estimate e = estimate_of({name, name, unit, "", candidate.lower[k]}, rig.linear_motion, s,
                             index, {job.options.honest_sd});
    if (name == "offset" && nuisance.theta_0) {
      e = zero_of_line(s, index, zero, rig.linear_motion, job.options.honest_sd);
    } else if (name == "theta_0") {
      e.value += zero;
      e.ci_low += zero;
      e.ci_high += zero;
    }
    if (e.name == "theta_0") fit.transmission.theta_0(0) = e.value;
    if (e.name == "offset") fit.offset = e.value;
    fit.parameters.push_back(std::move(e));
  }
  return fit;
}

}  // namespace cablefit
