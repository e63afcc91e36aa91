// Recursive least squares: the weighted fit, row after row, with its trace.
#include <algorithm>
#include <filesystem>

#include "cablefit/dynamic/estimators/least_squares_fit.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"

namespace cablefit::estimation {
namespace {

constexpr Eigen::Index kPoints = 200;  // of the trace

/// The equations of one system, and what has been seen of them.
struct System {
  std::vector<std::size_t> equations;
  std::vector<JointBlock> blocks;  ///< one per equation
  RecursiveInformation information;
};

std::vector<std::string> names_of(const DynamicColumns& columns) {
  std::vector<std::string> names;
  for (const DynamicParameter& parameter : columns.parameters) names.push_back(parameter.name);
  return names;
}

/// What the direct fit holds at 0: bounds, and given values, which its response contains.
Eigen::MatrixXd equalities_of(const LinearSolution& s, const DynamicColumns& columns) {
  const Eigen::Index p = s.x.size();
  Eigen::MatrixXd rows(0, p);
  for (Eigen::Index k = 0; k < p; ++k) {
    const auto place = static_cast<std::size_t>(k);
    if (!s.at_bound[place] && !columns.parameters[place].given) continue;
    rows.conservativeResize(rows.rows() + 1, p);
    rows.row(rows.rows() - 1) = Eigen::RowVectorXd::Unit(p, k);
  }
  return rows;
}

JointBlock block_of(const EstimationTask& task, const EquationRows& e, const LinearSolution& s) {
  const Eigen::Index p = s.x.size();
  JointBlock block;
  block.regressors = Eigen::MatrixXd::Identity(e.columns.count, p);
  block.response = s.residual_combination;
  block.response.head(p) += s.x;
  const LinearSolution own = solve_equation(e, task.job.elastic, task.model);
  if (own.rss > 0) block.weight = static_cast<double>(e.rows->n_rows()) / own.rss;
  return block;
}

std::vector<System> systems(const EstimationTask& task, const Estimation& direct) {
  std::vector<System> all;
  for (const std::vector<std::size_t>& equations : systems_of(task.equations)) {
    const DynamicColumns& columns = task.equations[equations.front()].columns;
    const LinearSolution& s = direct.solutions[equations.front()];
    System system{equations, {}, {names_of(columns), equalities_of(s, columns)}};
    for (const std::size_t k : equations)
      system.blocks.push_back(block_of(task, task.equations[k], direct.solutions[k]));
    all.push_back(std::move(system));
  }
  return all;
}

/// What is known of all systems, in the order of the parameters.
TracePoint point_of(const std::vector<System>& all, const std::string& record) {
  TracePoint point;
  point.record = record;
  for (const System& system : all) {
    const TracePoint own = system.information.point(record);
    point.n_rows += own.n_rows;
    point.value.insert(point.value.end(), own.value.begin(), own.value.end());
    point.sd.insert(point.sd.end(), own.sd.begin(), own.sd.end());
  }
  return point;
}

void take_rows(std::vector<System>& all, const RowBatch& batch, Eigen::Index first,
               Eigen::Index step) {
  for (System& system : all)
    for (std::size_t k = 0; k < system.equations.size(); ++k) {
      const Eigen::MatrixXd& rows = batch.equations[system.equations[k]].rows;
      const Eigen::Index n = std::min(step, rows.rows() - first);
      if (n > 0) system.information.add(system.blocks[k], rows.middleRows(first, n));
    }
}

void stream_into(const EstimationTask& task, std::vector<System>& all, RecursiveTrace& trace) {
  std::vector<Equation> plain;
  Eigen::Index most_rows = 0;
  for (const EquationRows& e : task.equations) {
    plain.push_back(e.equation);
    most_rows = std::max(most_rows, e.rows->n_rows());
  }
  const Eigen::Index step = most_rows / kPoints + 1;
  const DynamicJob& job = task.job;
  stream_rows(
      job.logs, job.wanted, job.settings.rows, plain, job.options.samples.threads,
      [](RowBatch batch) { return batch; },
      [&](const RowBatch& batch) {
        const std::string record =
            std::filesystem::path(job.logs[batch.log].plan.path).filename().string();
        Eigen::Index longest = 0;
        for (const EquationBatch& e : batch.equations) longest = std::max(longest, e.rows.rows());
        for (Eigen::Index first = 0; first < longest; first += step) {
          take_rows(all, batch, first, step);
          trace.points.push_back(point_of(all, record));
        }
      });
}

Estimation estimate(const EstimationTask& task) {
  Estimation out = least_squares_fit(task, Weighting::by_residual);
  std::vector<System> all = systems(task, out);
  RecursiveTrace trace;
  for (const Estimate& e : out.fit.parameters) {
    trace.names.push_back(e.name);
    trace.preloads.push_back(task.job.preload);
    trace.units.push_back(e.unit);
  }
  stream_into(task, all, trace);
  end_at(out.fit.parameters, trace);
  out.fit.trace = std::move(trace);
  return out;
}

}  // namespace

Estimator recursive() {
  return {"recursive", "R-LSA: the weighted fit row after row, with its trace in a CSV file",
          "Bierman 1977, ch. V", estimate};
}

}  // namespace cablefit::estimation
