#include "cablefit/identify/equations/joint_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cablefit/elastic/models/passivity.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kTrialsPerPass = 16;  // what fits the memory of a window's rows

std::vector<double> key_of(const Eigen::VectorXd& l_o) {
  return {l_o.data(), l_o.data() + l_o.size()};
}

/// Rows of one job for the elongations, `l_o` without repetition.
std::map<std::vector<double>, JointFit::Rows> rows_for(JointFit& fit, std::size_t job,
                                                       const std::set<std::vector<double>>& l_o,
                                                       bool with_cells) {
  std::map<std::vector<double>, JointFit::Rows> found;
  std::vector<Eigen::VectorXd> trials;
  const auto flush = [&] {
    if (trials.empty()) return;
    JointRows rows = collect(fit.logs, fit.jobs[job], trials, with_cells, fit.threads);
    fit.facts[job] = rows.facts;
    for (std::size_t t = 0; t < trials.size(); ++t)
      found[key_of(trials[t])] =
          std::make_shared<const std::vector<RowStatistics>>(std::move(rows.rows[t]));
    trials.clear();
  };
  for (const std::vector<double>& values : l_o) {
    trials.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
    if (trials.size() == kTrialsPerPass || with_cells) flush();
  }
  flush();
  return found;
}

bool breaks_bounds(const JointFit& fit, const Elongations& l_o, const Eigen::VectorXd& x) {
  for (Eigen::Index k = 0; k < fit.layout.n_linear; ++k)
    if (x(k) < fit.layout.parameters[static_cast<std::size_t>(k)].lower) return true;
  if (fit.unconstrained) return false;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
    const Transmission cables = fitted_cables(fit.jobs[j], l_o[j], x);
    const std::vector<double> longest = longest_of(fit.elongations(j, l_o[j]));
    for (std::size_t c = 0; c < longest.size(); ++c)
      if (find_push(cables.cables[c], longest[c])) return true;
  }
  return false;
}

}  // namespace

ElongationRange JointFit::displacements(std::size_t job, std::size_t cable) const {
  ElongationRange range;
  for (const EquationFacts& f : facts[job]) range.include(f.displacements[cable]);
  return range;
}

std::vector<ElongationRange> JointFit::elongations(std::size_t job,
                                                   const Eigen::VectorXd& l_o) const {
  std::vector<ElongationRange> ranges;
  for (Eigen::Index c = 0; c < l_o.size(); ++c) {
    const ElongationRange range = displacements(job, static_cast<std::size_t>(c));
    ranges.push_back({range.low + l_o(c), range.high + l_o(c)});
  }
  return ranges;
}

JointFit make_joint_fit(std::span<const LogSurvey> logs, std::vector<PreloadJob> jobs,
                        bool inertias_apart, bool unconstrained, int threads) {
  JointFit fit{logs, std::move(jobs), {}, {}, unconstrained, threads};
  fit.layout = joint_layout(fit.jobs, inertias_apart);
  fit.known.resize(fit.jobs.size());
  fit.facts.resize(fit.jobs.size());
  for (const PreloadJob& job : fit.jobs)
    for (const JointRecord& record : job.records)
      fit.weights.insert(fit.weights.end(), record.equations.size(), 1.0);
  return fit;
}

JointInput JointPoint::input() const {
  JointInput input{l_o, {}};
  for (const JointFit::Rows& job : rows) input.rows.push_back(job.get());
  return input;
}

std::vector<JointPoint> evaluate(JointFit& fit, const std::vector<Elongations>& points,
                                 bool with_cells) {
  std::vector<JointPoint> evaluated(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) evaluated[p].l_o = points[p];
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
    std::set<std::vector<double>> wanted;
    for (const Elongations& point : points)
      if (with_cells || !fit.known[j].contains(key_of(point[j]))) wanted.insert(key_of(point[j]));
    auto found = rows_for(fit, j, wanted, with_cells);
    if (!with_cells) fit.known[j].merge(found);
    const auto& all = with_cells ? found : fit.known[j];
    for (JointPoint& point : evaluated) point.rows.push_back(all.at(key_of(point.l_o[j])));
  }
  for (JointPoint& point : evaluated) point.solution = solve_bounded(fit, point);
  return evaluated;
}

PhysicalBounds physical_bounds(const JointFit& fit, const Elongations& l_o) {
  const Eigen::Index n = fit.layout.n_linear;
  PhysicalBounds bounds;
  std::vector<Eigen::RowVectorXd> rows;
  for (Eigen::Index k = 0; k < n; ++k) {
    const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
    if (p.lower != 0) continue;
    rows.emplace_back(Eigen::RowVectorXd::Unit(n, k));
    bounds.texts.push_back(fmt::format("{} >= 0", p.name));
    bounds.parameters.push_back(k);
  }
  for (std::size_t j = 0; j < fit.jobs.size() && !fit.unconstrained; ++j) {
    const PreloadJob& job = fit.jobs[j];
    const ElongationUnit unit{job.cable_space, job.axes.all()};
    const Transmission cables = with_elongations(job.transmission, l_o[j]);
    const PullConstraints pull =
        pull_constraints(cables, std::vector<bool>(cables.cables.size(), true),
                         longest_of(fit.elongations(j, l_o[j])));
    for (Eigen::Index i = 0; i < pull.rows.rows(); ++i) {
      rows.emplace_back(Eigen::RowVectorXd::Zero(n));
      rows.back().head(pull.rows.cols()) = pull.rows.row(i);
      const PullBound& bound = pull.bounds[static_cast<std::size_t>(i)];
      bounds.texts.push_back(fmt::format("cable {}: k(l) >= 0 at l = {}",
                                         cables.cables[bound.cable].name, unit.text(bound.at)));
      bounds.parameters.push_back(-1);
    }
  }
  bounds.rows.resize(static_cast<Eigen::Index>(rows.size()), n);
  for (std::size_t i = 0; i < rows.size(); ++i)
    bounds.rows.row(static_cast<Eigen::Index>(i)) = rows[i];
  return bounds;
}

JointSolution solve_bounded(const JointFit& fit, const JointPoint& point) {
  JointProblem problem = joint_problem(fit.jobs, fit.layout, point.input(), fit.weights, {});
  JointSolution plain = solve(problem);
  if (!breaks_bounds(fit, point.l_o, plain.x)) return plain;
  problem.inequalities = physical_bounds(fit, point.l_o).rows;
  return solve(problem);
}

std::vector<DeflectionRange> deflections_of(const JointFit& fit, std::size_t job,
                                            const JointPoint& point) {
  const PreloadJob& of = fit.jobs[job];
  if (of.n_joints() == 1)
    return {reference_deflections(fitted_cables(of, point.l_o[job], point.solution.x),
                                  fit.elongations(job, point.l_o[job]))};
  std::vector<DeflectionRange> ranges(static_cast<std::size_t>(of.n_joints()),
                                      {kUnbounded, -kUnbounded});
  std::size_t e = 0;
  for (const JointRecord& record : of.records)
    for (const JointEquation& equation : record.equations) {
      const EquationFacts& seen = fit.facts[job][e++];
      DeflectionRange& range = ranges[static_cast<std::size_t>(equation.joint)];
      range.low = std::min(range.low, seen.deflection_low);
      range.high = std::max(range.high, seen.deflection_high);
    }
  return ranges;
}

std::vector<double> own_variances(const JointFit& fit, const JointPoint& point) {
  const std::vector<double> ones(fit.weights.size(), 1.0);
  JointProblem all = joint_problem(fit.jobs, fit.layout, point.input(), ones, {false, {}});
  std::vector<double> variances;
  for (const JointBlock& block : all.blocks) {
    JointProblem one;
    one.blocks = {block};
    one.names = all.names;
    variances.push_back(solve(one).rss.front() /
                        std::max<double>(1, static_cast<double>(block.rows->n_rows())));
  }
  return variances;
}

}  // namespace cablefit
