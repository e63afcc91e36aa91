#include "cablefit/identify/results/recursive.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

/// Equilibrium and the bounds that hold the direct fit, as equalities.
Eigen::MatrixXd equalities_of(const JointFit& fit, const JointPoint& point,
                              const JointProblem& direct) {
  Eigen::MatrixXd rows = direct.equalities;
  const Eigen::MatrixXd bounds = physical_bounds(fit, point.l_o).rows;
  for (const Eigen::Index i : point.solution.active) {
    rows.conservativeResize(rows.rows() + 1, direct.n_params());
    rows.row(rows.rows() - 1) = bounds.row(i);
  }
  return rows;
}

/// One record of one job: `blocks` are those of its equations.
void take_record(const JointFit& fit, const JointRecord& record, const Transmission& cables,
                 const std::string& name, std::span<const JointBlock> blocks, Eigen::Index step,
                 RecursiveInformation& information, RecursiveTrace& trace) {
  std::vector<Equation> equations;
  for (const JointEquation& equation : record.equations)
    equations.push_back(equation_at(equation, cables));
  stream_rows(
      fit.logs, record.wanted, record.settings, equations, fit.threads,
      [](RowBatch batch) { return batch; },
      [&](const RowBatch& batch) {
        Eigen::Index longest = 0;
        for (const EquationBatch& e : batch.equations) longest = std::max(longest, e.rows.rows());
        for (Eigen::Index first = 0; first < longest; first += step) {
          for (std::size_t e = 0; e < equations.size(); ++e) {
            const Eigen::MatrixXd& rows = batch.equations[e].rows;
            const Eigen::Index n = std::min(step, rows.rows() - first);
            if (n > 0) information.add(blocks[e], rows.middleRows(first, n));
          }
          trace.points.push_back(information.point(name));
        }
      });
}

}  // namespace

RecursiveTrace recursive_trace(const JointFit& fit, const JointPoint& point,
                               const std::vector<Estimate>& estimates, int n_points) {
  const JointProblem direct = joint_problem(fit.jobs, fit.layout, point.input(), fit.weights, {});
  RecursiveTrace trace;
  for (Eigen::Index k = 0; k < fit.layout.n_linear; ++k) {
    const JointParameter& p = fit.layout.parameters[static_cast<std::size_t>(k)];
    trace.names.push_back(p.name);
    trace.preloads.push_back(
        p.preload == kShared ? "all" : fit.jobs[static_cast<std::size_t>(p.preload)].name);
    trace.units.push_back(p.unit);
  }
  RecursiveInformation information(direct.names, equalities_of(fit, point, direct));
  std::size_t block = 0;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
    const Transmission cables = with_elongations(fit.jobs[j].transmission, point.l_o[j]);
    for (const JointRecord& record : fit.jobs[j].records) {
      const std::size_t n = record.equations.size();
      Eigen::Index rows = 1;
      for (std::size_t e = 0; e < n; ++e)
        rows = std::max(rows, direct.blocks[block + e].rows->n_rows());
      const std::string name =
          fit.jobs[j].name + (record.equations.front().blocked ? ", blocked" : ", moving");
      take_record(fit, record, cables, name, std::span(direct.blocks).subspan(block, n),
                  rows / n_points + 1, information, trace);
      block += n;
    }
  }
  for (TracePoint& at : trace.points)
    for (std::size_t k = 0; k < at.value.size(); ++k) at.value[k] += fit.layout.parameters[k].known;
  end_at(estimates, trace);
  return trace;
}

}  // namespace cablefit
