#include "cablefit/identify/results/identify_preload.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/least_squares.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

/// Torque of the fitted cables as a combination of an equation's columns.
Eigen::VectorXd elastic_combination(const JointEquation& equation, const JointFit& fit,
                                    const Eigen::VectorXd& x) {
  const JointColumns c = joint_columns(equation, fit.layout.n_coefficients);
  Eigen::VectorXd combination = Eigen::VectorXd::Zero(c.count);
  combination.segment(c.basis, fit.layout.n_coefficients) = x.head(fit.layout.n_coefficients);
  return combination;
}

/// The slope of the straight line through `response`, beside the equation's own columns.
LinearSolution line_through(const RowStatistics& rows, const JointEquation& equation,
                            const JointFit& fit, const Eigen::VectorXd& response) {
  LinearProblem problem;
  problem.regressors = {joint_columns(equation, fit.layout.n_coefficients).deflection};
  problem.names = {"K"};
  for (const JointEquation::Own& own : equation.own) {
    problem.regressors.push_back(own.column);
    problem.names.push_back(own.name);
  }
  problem.response = response;
  return solve(rows, problem);
}

LineStiffness line_of(const JointFit& fit, const JudgedPoint& judged, std::size_t job,
                      const JointEquation& equation, std::size_t e) {
  const RowStatistics& rows = (*judged.point.rows[job])[e];
  const EquationFacts& facts = fit.facts[job][e];
  const Eigen::Index count = joint_columns(equation, fit.layout.n_coefficients).count;
  const LinearSolution measured =
      line_through(rows, equation, fit, Eigen::VectorXd::Unit(count, equation.response));
  const LinearSolution model = line_through(
      rows, equation, fit, elastic_combination(equation, fit, judged.point.solution.x));
  return {joint_parameter_name("K", equation.joint + 1, fit.jobs[job].n_joints()),
          facts.deflection_low,
          facts.deflection_high,
          measured.x(0),
          std::sqrt(measured.covariance(0, 0)),
          model.x(0)};
}

std::vector<LineStiffness> lines_of(const JointFit& fit, const JudgedPoint& judged,
                                    std::size_t job) {
  std::vector<LineStiffness> lines;
  std::size_t e = 0;
  for (const JointRecord& record : fit.jobs[job].records)
    for (const JointEquation& equation : record.equations) {
      if (equation.blocked) lines.push_back(line_of(fit, judged, job, equation, e));
      ++e;
    }
  return lines;
}

std::vector<IdentifyEquation> equations_of(const JointFit& fit, const JudgedPoint& judged,
                                           std::size_t job) {
  std::size_t block = 0, e = 0;
  for (std::size_t j = 0; j < job; ++j) block += fit.facts[j].size();
  std::vector<IdentifyEquation> equations;
  for (const JointRecord& record : fit.jobs[job].records)
    for (const JointEquation& equation : record.equations) {
      const double n = static_cast<double>((*judged.point.rows[job])[e].n_rows());
      const double rss = judged.point.solution.rss[block];
      IdentifyEquation out;
      out.name = equation.base.name;
      out.side = equation.blocked ? "blocked" : equation.motor_side ? "motor" : "link";
      out.counts = fit.facts[job][e].counts;
      out.rms = n > 0 ? std::sqrt(rss / n) : 0;
      out.weight = fit.weights[block];
      out.effective_rows = std::min(n, out.weight * rss);
      equations.push_back(out);
      ++block;
      ++e;
    }
  return equations;
}

}  // namespace

IdentifyPreload preload_of(const JointFit& fit, const JudgedPoint& judged, std::size_t job,
                           const PreloadFacts& facts) {
  IdentifyPreload preload;
  preload.name = facts.name;
  preload.rig_path = facts.rig.path;
  preload.transmission =
      fitted_cables(fit.jobs[job], judged.point.l_o[job], judged.point.solution.x);
  preload.elongations = fit.elongations(job, judged.point.l_o[job]);
  const std::vector<DeflectionRange> ranges = deflections_of(fit, job, judged.point);
  preload.deflection_low = ranges.front().low;
  preload.deflection_high = ranges.front().high;
  for (const DeflectionRange& range : ranges) {
    preload.deflection_low = std::min(preload.deflection_low, range.low);
    preload.deflection_high = std::max(preload.deflection_high, range.high);
  }
  const PreloadTorques torques = preload_torques(preload.transmission);
  preload.equilibrium =
      std::max(torques.link.cwiseAbs().maxCoeff(), torques.motor.cwiseAbs().maxCoeff());
  preload.lines = lines_of(fit, judged, job);
  preload.equations = equations_of(fit, judged, job);
  preload.delay = facts.delay;
  preload.resonance = facts.resonance;
  preload.load_inertia = facts.load_inertia;
  preload.decisions = facts.decisions;
  preload.warnings = facts.warnings;
  return preload;
}

}  // namespace cablefit
