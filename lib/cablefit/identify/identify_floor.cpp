#include "cablefit/identify/identify_floor.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/dynamic/method_floor.hpp"
#include "cablefit/estimate/parameter_estimate.hpp"
#include "cablefit/identify/joint_solution.hpp"
#include "cablefit/identify/preload_records.hpp"

namespace cablefit {
namespace {

/// Place of a parameter among the estimates: the preload's own, else the shared one; -1: neither.
Eigen::Index place_of(const JointFit& fit, const std::string& name, std::size_t job) {
  const Eigen::Index own = fit.layout.find(name, static_cast<int>(job));
  return own >= 0 ? own : fit.layout.find(name, kShared);
}

/// The fitted values as solutions of the two equations of stage 2.
std::vector<LinearSolution> as_solutions(const JointFit& fit,
                                         const std::vector<Estimate>& estimates,
                                         const std::vector<EquationRows>& equations,
                                         std::size_t job) {
  std::vector<LinearSolution> solutions;
  for (const EquationRows& e : equations) {
    LinearSolution& s = solutions.emplace_back();
    s.x = Eigen::VectorXd::Zero(e.columns.n_effects);
    s.not_identifiable.assign(static_cast<std::size_t>(e.columns.n_effects), "");
    for (Eigen::Index k = 0; k < e.columns.n_effects; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const Eigen::Index place = place_of(fit, e.columns.parameters[at].name, job);
      const Estimate* found = place < 0 ? nullptr : &estimates[static_cast<std::size_t>(place)];
      if (found != nullptr && found->not_identifiable.empty())
        s.x(k) = found->value;
      else
        s.not_identifiable[at] = "not fitted";
    }
  }
  return solutions;
}

}  // namespace

void add_method_floor(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                      const JointFit& fit, const JudgedPoint& judged,
                      std::vector<PreloadFacts>& facts, std::vector<Estimate>& estimates) {
  if (!options.honest_sd) return;
  std::vector<double> variance(estimates.size(), 0);
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
    if (!facts[j].has_moving) continue;
    const Transmission cables =
        fitted_cables(fit.jobs[j], judged.point.l_o[j], judged.point.solution.x);
    MovingJob moving(logs, options, cables,
                     reference_deflections(cables, fit.elongations(j, judged.point.l_o[j])),
                     facts[j]);
    const std::vector<EquationRows> equations = make_equations(moving.job);
    const MethodFloor floor =
        method_floor(moving.job, equations, as_solutions(fit, estimates, equations, j),
                     std::vector<bool>(equations.size(), false), 0);
    for (std::size_t e = 0; e < floor.variance.size(); ++e)
      for (Eigen::Index k = 0; k < equations[e].columns.n_effects; ++k) {
        const Eigen::Index place =
            place_of(fit, equations[e].columns.parameters[static_cast<std::size_t>(k)].name, j);
        if (place < 0) continue;
        double& of_parameter = variance[static_cast<std::size_t>(place)];
        of_parameter = std::max(of_parameter, floor.variance[e](k));
      }
    facts[j].decisions.push_back({"moving: method's floor", "in every sd", floor.note});
  }
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    Estimate& e = estimates[k];
    if (e.not_identifiable.empty() && e.sd > 0)
      widen_interval(e, std::sqrt(1 + variance[k] / (e.sd * e.sd)));
  }
}

}  // namespace cablefit
