#include "cablefit/identify/identify_floor.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/dynamic/checks/low_cutoff.hpp"
#include "cablefit/dynamic/loops/method_floor.hpp"
#include "cablefit/dynamic/loops/model_of_solutions.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/identify/elongations/joint_solution.hpp"
#include "cablefit/identify/preload_records.hpp"

namespace cablefit {
namespace {

constexpr const char* kMotorInertia = "J_motor";

/// The fitted values as solutions of the two equations of stage 2.
std::vector<LinearSolution> as_solutions(const JointFit& fit, const JudgedPoint& judged,
                                         const std::vector<EquationRows>& equations,
                                         std::size_t job) {
  std::vector<LinearSolution> solutions;
  for (const EquationRows& e : equations) {
    LinearSolution& s = solutions.emplace_back();
    s.x = Eigen::VectorXd::Zero(e.columns.n_effects);
    for (Eigen::Index k = 0; k < e.columns.n_effects; ++k) {
      const Eigen::Index place = fit.layout.find(
          e.columns.parameters[static_cast<std::size_t>(k)].name, static_cast<int>(job));
      if (place < 0) continue;  // given by the rig file
      const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(place)];
      s.x(k) = judged.point.solution.x(place);
      if (p.inertia && e.columns.side == Side::link) s.x(k) += fit.jobs[job].load_inertia;
    }
  }
  return solutions;
}

/// By how much a copy of one preload's moving logs moves the solution: its rows leave residuals
/// with the values that it was simulated with, and the estimates follow them as they follow those
/// of the logs.
Eigen::VectorXd shift_by(const JointFit& fit, const JudgedPoint& judged, std::size_t job,
                         const CopyDraw& draw) {
  std::vector<PreloadJob> jobs = fit.jobs;
  std::vector<double> weights;
  std::size_t block = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j)
    for (const JointRecord& record : fit.jobs[j].records)
      for (std::size_t e = 0; e < record.equations.size(); ++e, ++block)
        if (j == job && &record == &fit.jobs[job].records.back())
          weights.push_back(fit.weights[block]);
  for (PreloadJob& other : jobs) other.records.clear();
  jobs[job].records = {fit.jobs[job].records.back()};
  const JointRows rows = collect(draw.logs, jobs[job], {judged.point.l_o[job]}, false, fit.threads);
  const std::vector<RowStatistics> none;
  JointInput input{judged.point.l_o, std::vector(jobs.size(), &none)};
  input.rows[job] = &rows.rows.front();
  const JointProblem problem =
      joint_problem(jobs, fit.layout, input, weights, {false, judged.point.solution.x});
  Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.n_params());
  x.head(fit.layout.n_linear) = judged.point.solution.x;
  Eigen::VectorXd score = Eigen::VectorXd::Zero(problem.n_params());
  for (const JointBlock& b : problem.blocks) {
    const Eigen::MatrixXd columns = b.rows->r() * b.regressors;
    score += b.weight / draw.share * columns.transpose() *
             (b.rows->r() * (b.response - b.regressors * x));
  }
  return judged.linearised.solve_operator * score;
}

/// Adds the mean shift over the draws; returns how it was measured, or why it was not.
Decision add_shift(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                   const JointFit& fit, const JudgedPoint& judged, std::size_t job,
                   const PreloadFacts& facts, Eigen::VectorXd& shift) {
  const MovingJob moving(logs, options, fit, judged, job, facts);
  const std::vector<EquationRows> equations = make_equations(moving.job);
  const Model model =
      model_of_solutions(moving.job, equations, as_solutions(fit, judged, equations, job), 0);
  try {
    Eigen::VectorXd own = Eigen::VectorXd::Zero(shift.size());
    CopyDraws(moving.job, model, false, true).for_each([&](const CopyDraw& copy) {
      own += copy.weight * shift_by(fit, judged, job, copy);
    });
    shift += own;
    return {"moving: method's floor", "in every sd", kFloorNote};
  } catch (const Error& error) {
    return {"moving: method's floor", "not in the sd",
            fmt::format("not measured: {}", error.what())};
  }
}

void note_low_cutoffs(const Estimate& j_motor, double error, std::vector<PreloadFacts>& facts) {
  for (PreloadFacts& preload : facts)
    for (std::size_t k = 0; k < preload.cutoffs.size(); ++k) {
      const int n = preload.rig.n_joints();
      if (j_motor.name != joint_parameter_name(kMotorInertia, static_cast<int>(k) + 1, n)) continue;
      std::string warning =
          low_cutoff_warning(preload.cutoffs[k], preload.resonances[k], j_motor, error, true);
      if (!warning.empty()) preload.warnings.push_back(std::move(warning));
    }
}

}  // namespace

void add_method_floor(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                      const JointFit& fit, const JudgedPoint& judged,
                      std::vector<PreloadFacts>& facts, std::vector<Estimate>& estimates) {
  if (!options.robust_sd) return;
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(estimates.size()));
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    if (facts[j].has_moving)
      facts[j].decisions.push_back(add_shift(logs, options, fit, judged, j, facts[j], shift));
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    Estimate& e = estimates[k];
    const double error = shift(static_cast<Eigen::Index>(k));
    if (e.not_identifiable.empty() && e.sd > 0) widen_interval(e, std::hypot(1, error / e.sd));
    note_low_cutoffs(e, error, facts);
  }
}

}  // namespace cablefit
