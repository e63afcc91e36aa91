#include "cablefit/elastic/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cablefit/estimate/long_run.hpp"

namespace cablefit {
namespace {

constexpr double kTautShare = 0.02;

void add_nuisance(Candidate& candidate, const BlockedRows& rows, const Nuisance& nuisance) {
  const auto add = [&](Eigen::Index column, const char* name, double lower) {
    candidate.regressors.push_back(column);
    candidate.names.emplace_back(name);
    candidate.lower.push_back(lower);
    candidate.held.emplace_back();
  };
  if (nuisance.theta_0 && candidate.model != "linear") {
    add(rows.columns.zero, "theta_0", -kUnbounded);
  } else {
    add(rows.columns.offset, "offset", -kUnbounded);
  }
  if (nuisance.branches) add(rows.columns.direction, "f_sm", 0);
  if (nuisance.speed) add(rows.columns.speed, "f_vm", -kUnbounded);
}

/// Pulled so little (first basis column, as rms, against what the rms deflection would give) that
/// its coefficients would be fitted to noise about its slack point.
bool hardly_taut(const BlockedRows& rows, const Cable& cable, Eigen::Index first_column) {
  const auto& r = rows.rows->r();
  const double n = std::sqrt(static_cast<double>(rows.rows->n_rows()));
  const double radius = std::abs(cable.motor_map.front().radius(0));
  const double stretch = radius * r.col(rows.columns.deflection).norm() / n;
  std::array<double, kMaxCableOrder> basis{};
  if (stretch > 0) cable.law->basis(cable.shape(), stretch, basis.data());
  return r.col(first_column).norm() / n < kTautShare * radius * basis[0];
}

Estimate estimate_of(const std::string& name, const std::string& unit, Eigen::Index k,
                     const LinearSolution& s) {
  Estimate e;
  e.name = name;
  e.symbol = name;
  e.unit = unit;
  e.not_identifiable = s.not_identifiable[static_cast<std::size_t>(k)];
  if (!e.not_identifiable.empty()) return e;
  e.value = s.x(k);
  if (s.at_bound[static_cast<std::size_t>(k)]) {
    e.active_bound = fmt::format("{} >= 0", name);
    e.sd = s.unbounded_sd(k);
    e.ci_low = 0;
    e.ci_high = std::max(0.0, s.unbounded_x(k) + t_quantile_975(s.degrees_of_freedom) * e.sd);
    return e;
  }
  e.sd = std::sqrt(s.covariance(k, k));
  e.sd_white = std::sqrt(s.covariance_white(k, k));
  const double t = t_quantile_975(s.degrees_of_freedom);
  e.ci_low = e.value - t * e.sd;
  e.ci_high = e.value + t * e.sd;
  return e;
}

std::string unit_of(const Candidate& candidate, std::size_t k, bool linear_motion,
                    bool cable_space) {
  std::string unit;
  if (k < candidate.n_elastic) {
    if (candidate.model == "linear") {
      unit = "N m/rad";
    } else {
      std::size_t first = 0;
      for (const Cable& cable : candidate.transmission.cables) {
        const auto n = static_cast<std::size_t>(cable.n_coefficients());
        if (k < first + n) {
          unit = coefficient_unit(*cable.law, static_cast<int>(k - first), cable_space);
          break;
        }
        first += n;
      }
      if (cable_space) return unit;
    }
  } else {
    unit = candidate.names[k] == "theta_0" ? "rad"
           : candidate.names[k] == "f_vm"  ? "N m s/rad"
                                           : "N m";
  }
  return linear_motion ? linear_unit(unit) : unit;
}

void use_white_sd(Estimate& e) {
  if (!(e.sd > 0) || !(e.sd_white > 0)) return;
  const double shrink = e.sd_white / e.sd;
  e.ci_low = e.value - shrink * (e.value - e.ci_low);
  e.ci_high = e.value + shrink * (e.ci_high - e.value);
  e.sd = e.sd_white;
}

/// Linear spring with an arbitrary encoder zero: K phi + c = K (phi - theta_0), theta_0 = -c/K, by
/// the delta method.
Estimate zero_of_line(const LinearSolution& s, Eigen::Index constant, double zero,
                      bool linear_motion) {
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
  e.sd = sd(s.covariance);
  e.sd_white = sd(s.covariance_white);
  const double t = t_quantile_975(s.degrees_of_freedom);
  e.ci_low = e.value - t * e.sd;
  e.ci_high = e.value + t * e.sd;
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

Candidate linear_candidate(const BlockedRows& rows, const Nuisance& nuisance) {
  Candidate candidate;
  candidate.model = "linear";
  candidate.transmission.n_joints = rows.transmission.n_joints;
  candidate.transmission.linear_stiffness = Eigen::VectorXd::Zero(rows.transmission.n_joints);
  candidate.transmission.theta_0 = rows.transmission.theta_0;
  candidate.regressors = {rows.columns.deflection};
  candidate.names = {"K"};
  candidate.lower = {-kUnbounded};
  candidate.held = {""};
  candidate.n_elastic = 1;
  add_nuisance(candidate, rows, nuisance);
  return candidate;
}

Candidate poly_candidate(const ElasticJob& job, const BlockedRows& rows, int order,
                         const Nuisance& nuisance) {
  Candidate candidate;
  candidate.model = "poly";
  candidate.transmission =
      job.orders_given ? rows.transmission : with_order(rows.transmission, order);
  Eigen::Index first = rows.columns.basis;
  for (std::size_t c = 0; c < rows.transmission.cables.size(); ++c) {
    const Cable& cable = candidate.transmission.cables[c];
    candidate.order = std::max(candidate.order, cable.order);
    const std::string held =
        hardly_taut(rows, cable, first)
            ? fmt::format("cable {} was hardly ever taut in these logs", cable.name)
            : "";
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      candidate.regressors.push_back(first + k);
      candidate.names.push_back(coefficient_name(cable, k, job.rig().cables_given));
      candidate.lower.push_back(-kUnbounded);
      candidate.held.push_back(held);
    }
    first += rows.transmission.cables[c].n_coefficients();
  }
  candidate.n_elastic = candidate.regressors.size();
  add_nuisance(candidate, rows, nuisance);
  return candidate;
}

LinearSolution solve_candidate(const BlockedRows& rows, const Candidate& candidate) {
  return solve(*rows.rows, {candidate.regressors, candidate.names, candidate.lower,
                            rows.torque_response(), candidate.held});
}

Transmission fitted_transmission(const Candidate& candidate, const LinearSolution& s) {
  Transmission transmission = candidate.transmission;
  if (candidate.model == "linear") {
    transmission.linear_stiffness(0) = s.x(0);
    return transmission;
  }
  Eigen::Index next = 0;
  for (Cable& cable : transmission.cables) {
    cable.coefficients.assign(static_cast<std::size_t>(cable.n_coefficients()), 0.0);
    for (double& coefficient : cable.coefficients) coefficient = s.x(next++);
  }
  return transmission;
}

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
    const std::string unit = unit_of(candidate, k, rig.linear_motion, rig.cables_given);
    Estimate e = estimate_of(name, unit, index, s);
    if (name == "offset" && nuisance.theta_0) {
      e = zero_of_line(s, index, zero, rig.linear_motion);
    } else if (name == "theta_0") {
      e.value += zero;
      e.ci_low += zero;
      e.ci_high += zero;
    }
    if (!job.options.honest_sd) use_white_sd(e);
    if (e.name == "theta_0") fit.transmission.theta_0(0) = e.value;
    if (e.name == "offset") fit.offset = e.value;
    fit.parameters.push_back(std::move(e));
  }
  return fit;
}

}  // namespace cablefit
