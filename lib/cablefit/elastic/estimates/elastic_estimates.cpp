#include "cablefit/elastic/estimates/elastic_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cablefit/elastic/estimates/elastic_quantities.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

constexpr double kFarBeyond = 10;  // an interval so many times as wide as the values themselves

/// A coefficient of a cable.
struct Coefficient {
  std::size_t cable = 0;
  int index = 0;
};

/// Of candidate.names[k]; none for K and for what is estimated beside the elastic coefficients.
std::optional<Coefficient> coefficient_at(const ElasticCandidate& candidate, std::size_t k) {
  std::size_t first = 0;
  for (std::size_t c = 0; c < candidate.transmission.cables.size(); ++c) {
    const auto n = static_cast<std::size_t>(candidate.transmission.cables[c].n_coefficients());
    if (k < first + n) return Coefficient{c, static_cast<int>(k - first)};
    first += n;
  }
  return std::nullopt;
}

/// "f_sm" of "f_sm[2]".
std::string without_index(const std::string& name) { return name.substr(0, name.find('[')); }

/// On a rotary axis, or in cable space.
std::string unit_of(const ElasticCandidate& candidate, std::size_t k, bool cable_space) {
  if (const auto coefficient = coefficient_at(candidate, k))
    return coefficient_unit(*candidate.transmission.cables[coefficient->cable].law,
                            coefficient->index, cable_space);
  const std::string name = without_index(candidate.names[k]);
  return name == "K" ? "N m/rad" : name == "theta_0" ? "rad" : name == "f_vm" ? "N m s/rad" : "N m";
}

/// Joint (from 0) of "f_sm[2]"; of a rig of one joint 0.
int joint_of(const std::string& name) {
  const auto at = name.find('[');
  return at == std::string::npos ? 0 : std::stoi(name.substr(at + 1)) - 1;
}

/// Linear spring with an arbitrary encoder zero: K phi + c = K (phi - theta_0), theta_0 = -c/K, by
/// the delta method. `k`, `constant`: places of K and c.
Estimate zero_of_line(const LinearSolution& s, Eigen::Index k, Eigen::Index constant, double zero,
                      Axes axes, bool robust) {
  const double stiffness = s.x(k);
  const double by_stiffness = s.x(constant) / (stiffness * stiffness);
  const double by_constant = -1 / stiffness;
  const auto sd = [&](const Eigen::MatrixXd& c) {
    return std::sqrt(by_stiffness * by_stiffness * c(k, k) +
                     by_constant * by_constant * c(constant, constant) +
                     2 * by_stiffness * by_constant * c(k, constant));
  };
  Estimate e;
  e.name = e.symbol = "theta_0";
  e.unit = unit_for(axes, "rad");
  e.value = zero - s.x(constant) / stiffness;
  e.sd_white = sd(s.covariance_white);
  e.sd = robust ? sd(s.covariance) : e.sd_white;
  set_interval(e, s.degrees_of_freedom);
  return e;
}

/// How many of the names the warning says to be correlated: "A, B and C are strongly correlated".
std::size_t count_correlated(const std::string& warning, const std::vector<std::string>& names) {
  const std::string group = warning.substr(0, warning.find("are strongly correlated"));
  return static_cast<std::size_t>(
      std::count_if(names.begin(), names.end(), [&](const std::string& name) {
        return group.find(name + ' ') != std::string::npos ||
               group.find(name + ',') != std::string::npos;
      }));
}

/// Whether less than two of the correlated parameters have a value.
bool is_of_refused(const std::string& warning, const std::vector<std::string>& names,
                   const std::vector<std::string>& refused) {
  if (warning.find("are strongly correlated") == std::string::npos) return false;
  const std::size_t n_refused = count_correlated(warning, refused);
  return n_refused > 0 && count_correlated(warning, names) < n_refused + 2;
}

/// Coefficients of one cable are always strongly correlated: one warning, not one per pair, and
/// none of parameters that are refused.
std::vector<std::string> worth_saying(std::vector<std::string> warnings,
                                      const ElasticCandidate& candidate,
                                      const std::vector<std::string>& refused) {
  std::erase_if(warnings, [&](const std::string& warning) {
    return is_of_refused(warning, candidate.names, refused);
  });
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
        fmt::format("coefficients of order {} are strongly correlated: use the curve, not single "
                    "coefficients",
                    candidate.order));
  return kept;
}

/// "cable 1 only pulls", for a coefficient that this holds at 0.
std::string hold_text(const ElasticCandidate& candidate, std::size_t k) {
  const auto coefficient = coefficient_at(candidate, k);
  return fmt::format("cable {} only pulls",
                     candidate.transmission.cables.at(coefficient.value().cable).name);
}

/// "K1_0 = -3894.7 N m/rad, K1_1 = 3891.4 N m/rad^2".
std::string coefficients_text(const ElasticFit& fit, const Cable& cable, bool cable_space) {
  std::string text;
  for (std::size_t k = 0; k < cable.coefficients.size(); ++k) {
    const std::string name = coefficient_name(cable, static_cast<int>(k), cable_space);
    const Estimate* e = find_estimate(fit.parameters, name);
    text += fmt::format("{}{} = {:.5g} {}", k > 0 ? ", " : "", name, cable.coefficients[k],
                        e == nullptr ? "" : e->unit);
  }
  return text;
}

/// What was refused, why, and what it costs.
void note_active_bounds(const ElasticJob& job, const ElasticCandidate& candidate,
                        const LinearSolution& s, const BlockedRows& rows, ElasticFit& fit) {
  const Rig& rig = job.rig();
  const ElongationUnit unit{rig.cables_given, rig.axes.all()};
  for (const Eigen::Index i : s.active_constraints) {
    const PullBound& bound = candidate.pull.bounds[static_cast<std::size_t>(i)];
    fit.active_bounds.push_back(fmt::format("cable {}: k(l) >= 0 at l = {}",
                                            candidate.transmission.cables[bound.cable].name,
                                            unit.text(bound.at)));
  }
  const LinearSolution plain = solve_plain(rows, candidate);
  const Transmission pushing = fitted_transmission(candidate, plain.x);
  for (const PullRange& range : candidate.pull.ranges) {
    const Cable& cable = pushing.cables[range.cable];
    const std::optional<Push> push = find_push(cable, range.longest);
    if (!push) continue;
    fit.warnings.push_back(
        fmt::format("not used: {}, as {}; a cable only pulls, (5) and (16) of the paper, so k(l) "
                    ">= 0 is imposed: rms error {:.3g} instead of {:.3g} {}, sd given the active "
                    "bounds; --unconstrained gives the plain fit",
                    coefficients_text(fit, cable, rig.cables_given), push_text(cable, *push, unit),
                    s.rms(), plain.rms(), torque_unit(rig.axes.all())));
  }
}

/// Of the coefficients that have an sd; l_o is given here.
std::vector<Estimate> derived_of(const ElasticJob& job, const LinearSolution& s,
                                 const BlockedRows& rows, const ElasticFit& fit) {
  JointEstimates from;
  const Eigen::Index n = fit.covariance.rows();
  from.value.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Estimate& e = fit.parameters[static_cast<std::size_t>(k)];
    if (!e.not_identifiable.empty()) return {};
    from.names.push_back(e.name);
    from.value(k) = e.value;
  }
  from.covariance = fit.covariance;
  from.degrees_of_freedom = s.degrees_of_freedom;
  std::vector<Estimate> all;
  for (const DerivedQuantity& quantity :
       elastic_quantities(fit.transmission, job.rig().cables_given, job.rig().axes,
                          {rows.deflection_low, rows.deflection_high}, from)) {
    all.push_back(derive(quantity, from));
    if (!std::isfinite(all.back().value) || !(all.back().sd > 0)) all.pop_back();
  }
  return all;
}

/// A coefficient that the constraint holds at 0 although the logs allow values far beyond those of
/// the same power of l.
bool is_open_at_bound(const ElasticCandidate& candidate, const LinearSolution& s, const Estimate& e,
                      std::size_t k) {
  const std::optional<Coefficient> own = coefficient_at(candidate, k);
  if (!own || !s.at_bound[k] || !e.profiled) return false;
  double largest = 0;
  for (std::size_t j = 0; j < candidate.n_elastic; ++j)
    if (coefficient_at(candidate, j)->index == own->index)
      largest = std::max(largest, std::abs(s.x(static_cast<Eigen::Index>(j))));
  return e.ci_high - e.ci_low > kFarBeyond * largest;
}

/// Of the first `n` parameters.
std::vector<std::string> refused_names(const ElasticFit& fit, std::size_t n) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(n, fit.parameters.size()); ++k)
    if (!fit.parameters[k].not_identifiable.empty()) names.push_back(fit.parameters[k].name);
  return names;
}

/// Of many curves that fit the logs equally, the constraint chose one.
void refuse_value(Estimate& e) {
  e = refused_estimate(e, "only the constraint that cables pull determines it in these logs");
}

/// The motor's viscous friction, of whichever joint.
bool is_speed(const ElasticCandidate& candidate, std::size_t k) {
  return k >= candidate.n_elastic && without_index(candidate.names[k]) == "f_vm";
}

/// Of the joint that candidate.names[k] belongs to.
Axes axes_at(const ElasticCandidate& candidate, std::size_t k, const JointAxes& joints) {
  if (const auto coefficient = coefficient_at(candidate, k))
    return axes_of(joints, candidate.transmission.cables[coefficient->cable]);
  return joints.of(joint_of(candidate.names[k]));
}

}  // namespace

Estimate missing_friction(const ElasticJob& job, int joint) {
  Estimate e;
  e.name = e.symbol = joint_parameter_name("f_sm", joint + 1, job.basis.n_joints);
  e.unit = torque_unit(job.rig().axes.of(joint));
  e.not_identifiable = job.basis.n_joints > 1
                           ? fmt::format("theta{} moves in one direction only", joint + 1)
                           : "theta moves in one direction only";
  return e;
}

ElasticFit make_fit(const ElasticJob& job, const ElasticCandidate& candidate,
                    const LinearSolution& s, const BlockedRows& rows,
                    std::span<const Nuisance> nuisance) {
  const Rig& rig = job.rig();
  const auto n = static_cast<Eigen::Index>(candidate.n_elastic);
  ElasticFit fit;
  fit.model = candidate.model;
  fit.order = candidate.order;
  fit.condition = s.condition_scaled;
  fit.effective_rows = s.effective_rows;
  fit.rms_error = s.rms();
  fit.offset = rows.offset.value_or(0);
  fit.transmission = fitted_transmission(candidate, s.x);
  fit.covariance = (job.options.robust_sd ? s.covariance : s.covariance_white).topLeftCorner(n, n);
  for (std::size_t k = 0; k < candidate.names.size(); ++k) {
    const std::string& name = candidate.names[k];
    if (is_speed(candidate, k)) continue;  // a sweep this slow only keeps it out of f_sm
    const auto index = static_cast<Eigen::Index>(k);
    const std::string unit = unit_of(candidate, k, rig.cables_given);
    const Axes axes = axes_at(candidate, k, rig.axes);
    Estimate e = estimate_of({name, name, unit, "", candidate.lower[k]}, axes, s, index,
                             {job.options.robust_sd});
    const bool is_nuisance = k >= candidate.n_elastic;
    if ((!is_nuisance || without_index(name) == "offset") &&
        (is_held_by_bounds(e, s.degrees_of_freedom) || is_open_at_bound(candidate, s, e, k)))
      refuse_value(e);
    const int joint = is_nuisance ? joint_of(name) : 0;
    const double zero = rows.transmission.theta_0(joint);
    const bool is_zero = is_nuisance && without_index(name) == "theta_0";
    if (is_nuisance && without_index(name) == "offset" &&
        nuisance[static_cast<std::size_t>(joint)].theta_0) {
      e = zero_of_line(s, joint, index, zero, axes, job.options.robust_sd);
      e.name = e.symbol = joint_parameter_name("theta_0", joint + 1, job.basis.n_joints);
    } else if (is_zero) {
      e.value += zero;
      e.ci_low += zero;
      e.ci_high += zero;
    }
    if (s.at_bound[k] && candidate.lower[k] == -kUnbounded && e.not_identifiable.empty())
      e.active_bound = hold_text(candidate, k);
    if (is_nuisance && without_index(e.name) == "theta_0")
      fit.transmission.theta_0(joint) = e.value;
    if (e.name == "offset") fit.offset = s.x(index);  // of the curve, where it has no value itself
    fit.parameters.push_back(std::move(e));
  }
  fit.warnings = worth_saying(s.warnings, candidate, refused_names(fit, fit.parameters.size()));
  if (!is_linear(fit) && !refused_names(fit, candidate.n_elastic).empty())
    fit.warnings.emplace_back(
        "K_rest and slack points are not given: they follow from coefficients that these logs do "
        "not determine; let the cables go slack in a blocked log");
  fit.derived = derived_of(job, s, rows, fit);
  if (!s.active_constraints.empty()) note_active_bounds(job, candidate, s, rows, fit);
  return fit;
}

}  // namespace cablefit
