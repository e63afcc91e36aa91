#include "cablefit/identify/results/identify_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/estimates/joint_estimates.hpp"
#include "cablefit/elastic/estimates/elastic_quantities.hpp"
#include "cablefit/elastic/models/passivity.hpp"
#include "cablefit/identify/results/identify_checks.hpp"
#include "cablefit/identify/results/identify_model.hpp"
#include "cablefit/identify/results/identify_preload.hpp"
#include "cablefit/model/model_parameters.hpp"

namespace cablefit {
namespace {

constexpr double kCorrelationWarning = 0.95;  // estimation-rules: warn above

/// The elastic coefficients of one cable and its l_o are always strongly correlated.
std::vector<std::string> correlation_warnings(const JointFit& fit, const JudgedPoint& judged) {
  std::vector<std::string> warnings;
  const Eigen::MatrixXd& c = judged.linearised.solve_operator;
  for (Eigen::Index i = fit.layout.n_coefficients; i < fit.layout.n_linear; ++i)
    for (Eigen::Index k = 0; k < i; ++k) {
      const double scale = std::sqrt(c(i, i) * c(k, k));
      if (!(scale > 0) || std::abs(c(i, k)) < kCorrelationWarning * scale) continue;
      warnings.push_back(fmt::format("{} and {} are strongly correlated: {:.3f}",
                                     judged.problem.names[static_cast<std::size_t>(k)],
                                     judged.problem.names[static_cast<std::size_t>(i)],
                                     c(i, k) / scale));
    }
  return warnings;
}

void add_cad(const Rig& rig, std::vector<Estimate>& parameters) {
  for (Estimate& e : parameters)
    if (const auto found = rig.cad.find(e.name); found != rig.cad.end()) e.cad = found->second;
}

void note_pushing(const JointFit& fit, const IdentifyPreload& preload, IdentifyResult& result) {
  for (std::size_t c = 0; c < preload.transmission.cables.size(); ++c) {
    const Cable& cable = preload.transmission.cables[c];
    if (const std::optional<Push> push = find_push(cable, preload.elongations[c].high))
      result.warnings.push_back(
          push_text(cable, *push, {fit.jobs.front().cable_space, fit.jobs.front().axes.all()}));
  }
}

/// Results that depend on l_o are reported only where l_o is known, and for one joint only: with
/// several, a cable goes slack along a surface of poses.
void add_slack_points(IdentifyPreload& preload) {
  if (preload.knows_elongations() && preload.transmission.n_joints == 1)
    preload.slack =
        slack_points(preload.transmission, preload.deflection_low, preload.deflection_high);
}

/// One link, but each preload's J_link is that with its load.
bool under_several_loads(const JointFit& fit, std::size_t k) {
  const JointParameter& p = fit.layout.parameters[k];
  const bool of_link = std::any_of(
      base_effects(Side::link).begin(), base_effects(Side::link).end(), [&](const Effect& effect) {
        return effect.is_inertia() && effect.parameters.front().name == p.name;
      });
  return of_link && std::any_of(fit.jobs.begin(), fit.jobs.end(), [&](const PreloadJob& job) {
           return job.load_inertia != fit.jobs.front().load_inertia;
         });
}

void add_with_loads(const JointFit& fit, const Estimate& of_link, IdentifyResult& result) {
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
    Estimate& e = result.preloads[j].parameters.emplace_back(of_link);
    for (double* number : {&e.value, &e.ci_low, &e.ci_high}) *number += fit.jobs[j].load_inertia;
  }
}

/// What the rig file gives stands in Table 2 as in stage 2.
void add_given(const PreloadJob& job, IdentifyPreload& preload) {
  for (const JointRecord& record : job.records)
    for (const JointEquation& equation : record.equations)
      for (const JointEquation::Given& given : equation.given)
        preload.parameters.push_back(given_estimate(given.parameter));
}

void add_model(const PreloadFacts& facts, const JointEstimates& known, IdentifyResult& result,
               IdentifyPreload& preload) {
  std::string why_not;
  preload.model = model_of(result, preload, facts, why_not);
  if (!why_not.empty()) preload.warnings.push_back("no model file: " + why_not);
  if (!preload.model) return;
  std::vector<std::string> names;
  for (const ModelParameter& p : model_parameters(*preload.model)) names.push_back(p.name);
  preload.model->covariance = known.covariance_of(names);
}

/// The bounds that hold the solution; where a cable would push, that this was refused.
void note_active_bounds(const JointFit& fit, const JointPoint& point, IdentifyResult& result) {
  const PhysicalBounds bounds = physical_bounds(fit, point.l_o);
  std::string pushing;
  for (const Eigen::Index i : point.solution.active) {
    const auto k = static_cast<std::size_t>(i);
    result.active_bounds.push_back(bounds.texts[k]);
    if (bounds.parameters[k] < 0) pushing += (pushing.empty() ? "" : ", ") + bounds.texts[k];
  }
  if (pushing.empty()) return;
  result.warnings.push_back(
      fmt::format("not used: plain least squares gives a negative cable stiffness; a cable only "
                  "pulls, (5) and (16) of the paper, so {} is imposed and the sd are given the "
                  "active bounds; --unconstrained gives the plain fit",
                  pushing));
}

/// Of some parameters, correlated as in the fit, scaled to the final sd, which include the method's
/// floor.
Eigen::MatrixXd final_covariance(const Eigen::MatrixXd& all, const std::vector<Estimate>& estimates,
                                 const std::vector<Eigen::Index>& kept) {
  Eigen::VectorXd wider(static_cast<Eigen::Index>(kept.size()));
  for (Eigen::Index k = 0; k < wider.size(); ++k) {
    const Eigen::Index at = kept[static_cast<std::size_t>(k)];
    const double sd = std::sqrt(all(at, at));
    wider(k) = sd > 0 ? estimates[static_cast<std::size_t>(at)].sd / sd : 1;
  }
  return wider.asDiagonal() * all(kept, kept) * wider.asDiagonal();
}

/// What the preload's linear and shared parameters are known together as.
JointEstimates known_together(const JointFit& fit, const JudgedPoint& judged,
                              const std::vector<Estimate>& estimates, std::size_t job,
                              bool robust) {
  JointEstimates from;
  std::vector<Eigen::Index> kept;
  std::vector<double> values;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const Estimate& e = estimates[k];
    const int preload = fit.layout.parameters[k].preload;
    const bool is_its = preload == kShared || static_cast<std::size_t>(preload) == job;
    if (!is_its || !e.not_identifiable.empty() || !e.active_bound.empty() || !(e.sd >= 0)) continue;
    const double load =
        preload == kShared && under_several_loads(fit, k) ? fit.jobs[job].load_inertia : 0;
    from.names.push_back(e.name);
    values.push_back(e.value + load);
    kept.push_back(static_cast<Eigen::Index>(k));
  }
  from.value =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  from.covariance = final_covariance(
      robust ? judged.covariance.covariance : judged.covariance.white, estimates, kept);
  if (!kept.empty())
    from.degrees_of_freedom = judged.covariance.degrees_of_freedom(kept).minCoeff();
  return from;
}

void add_derived(const PreloadJob& job, const JointEstimates& from, IdentifyPreload& preload) {
  preload.derived = drive_quantities(from, &preload.transmission, job.cable_space, job.axes.all());
  for (const DerivedQuantity& quantity :
       elastic_quantities(preload.transmission, job.cable_space, job.axes,
                          {preload.deflection_low, preload.deflection_high}, from)) {
    const Estimate e = derive(quantity, from);
    if (find_estimate(preload.derived, e.name) == nullptr && std::isfinite(e.value) && e.sd > 0)
      preload.derived.push_back(e);
  }
}

/// Of every l_o that was searched and found.
ElongationCovariance searched_elongations(const JointFit& fit, const JudgedPoint& judged,
                                          const std::vector<Estimate>& estimates) {
  const Eigen::MatrixXd& all = judged.covariance.covariance;
  ElongationCovariance searched;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = fit.layout.n_linear; k < fit.layout.first_radius(); ++k) {
    const Estimate& e = estimates[static_cast<std::size_t>(k)];
    if (!e.not_identifiable.empty() || !(e.sd > 0) || !(all(k, k) > 0)) continue;
    const int job = fit.layout.parameters[static_cast<std::size_t>(k)].preload;
    searched.of.push_back({fit.jobs[static_cast<std::size_t>(job)].name, e.name});
    kept.push_back(k);
  }
  searched.matrix = final_covariance(all, estimates, kept);
  return searched;
}

}  // namespace

void describe(const JointFit& fit, const JudgedPoint& judged,
              const std::vector<Estimate>& estimates, const std::vector<PreloadFacts>& facts,
              const IdentifyOptions& options, IdentifyResult& result) {
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    add_given(fit.jobs[j], result.preloads.emplace_back(preload_of(fit, judged, j, facts[j])));
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    if (estimates[k].name.starts_with(kCreep)) continue;
    const int preload = fit.layout.parameters[k].preload;
    if (preload == kShared && under_several_loads(fit, k)) {
      add_with_loads(fit, estimates[k], result);
      continue;
    }
    (preload == kShared ? result.parameters
                        : result.preloads[static_cast<std::size_t>(preload)].parameters)
        .push_back(estimates[k]);
  }
  add_cad(facts.front().rig, result.parameters);
  for (std::size_t j = 0; j < facts.size(); ++j) {
    IdentifyPreload& preload = result.preloads[j];
    add_cad(facts[j].rig, preload.parameters);
    add_slack_points(preload);
    const JointEstimates known = known_together(fit, judged, estimates, j, options.robust_sd);
    if (preload.knows_elongations()) add_derived(fit.jobs[j], known, preload);
    add_model(facts[j], known, result, preload);
    note_pushing(fit, preload, result);
    for (std::string& warning : misfit_warnings(fit, judged, j, preload))
      preload.warnings.push_back(std::move(warning));
  }
  note_active_bounds(fit, judged.point, result);
  result.condition = judged.linearised.condition_scaled;
  const Eigen::Index n = fit.layout.n_coefficients;
  result.coefficient_covariance =
      (options.robust_sd ? judged.covariance.covariance : judged.covariance.white)
          .topLeftCorner(n, n);
  result.elongations = searched_elongations(fit, judged, estimates);
  const std::vector<std::string> correlated = correlation_warnings(fit, judged);
  result.warnings.insert(result.warnings.end(), correlated.begin(), correlated.end());
}

}  // namespace cablefit
