#include "cablefit/identify/recursive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

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

/// What has been seen so far: the triangular factor of [W y], weighted.
class Information {
 public:
  Information(const JointProblem& direct, Eigen::MatrixXd equalities)
      : seen_(direct.n_params() + 1, 1, false) {
    const Eigen::Index p = direct.n_params();
    problem_.names = direct.names;
    problem_.equalities = std::move(equalities);
    JointBlock block;
    block.regressors = Eigen::MatrixXd::Identity(p + 1, p);
    block.response = Eigen::VectorXd::Unit(p + 1, p);
    problem_.blocks = {block};
  }

  void add(const JointBlock& block, const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    Eigen::MatrixXd weighted(rows.rows(), block.regressors.cols() + 1);
    weighted << rows * block.regressors, rows * block.response;
    weighted *= std::sqrt(block.weight);
    const std::vector<Eigen::Index> numbers(static_cast<std::size_t>(rows.rows()), 0);
    seen_.add(weighted, numbers);
  }

  TracePoint point(const std::string& record) const {
    JointProblem problem = problem_;
    problem.blocks.front().rows = &seen_;
    const JointSolution s = solve(problem);
    TracePoint out{static_cast<std::size_t>(seen_.n_rows()), record, {}, {}};
    for (Eigen::Index k = 0; k < s.x.size(); ++k) {
      const bool known = s.determines(Eigen::VectorXd::Unit(s.x.size(), k)) &&
                         s.n_rows > s.n_params && seen_.r().col(k).norm() > 0;
      out.value.push_back(known ? s.x(k) : kNone);
      out.sd.push_back(known ? std::sqrt(std::max(0.0, s.solve_operator(k, k))) : kNone);
    }
    return out;
  }

 private:
  RowStatistics seen_;
  JointProblem problem_;
};

/// One record of one job: `blocks` are those of its equations.
void take_record(const JointFit& fit, const JointRecord& record, const Transmission& cables,
                 const std::string& name, std::span<const JointBlock> blocks, Eigen::Index step,
                 Information& information, RecursiveTrace& trace) {
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

void end_at(const JointLayout& layout, const std::vector<Estimate>& estimates,
            RecursiveTrace& trace) {
  const std::vector<double> last = trace.points.back().sd;
  for (TracePoint& point : trace.points)
    for (std::size_t k = 0; k < last.size(); ++k) {
      const Estimate& e = estimates[k];
      point.value[k] += layout.parameters[k].known;
      if (!e.not_identifiable.empty()) point.value[k] = kNone;
      const bool has_band = e.not_identifiable.empty() && e.active_bound.empty() && last[k] > 0;
      point.sd[k] = has_band ? point.sd[k] * e.sd / last[k] : kNone;
    }
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
  Information information(direct, equalities_of(fit, point, direct));
  std::size_t block = 0;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
    const Transmission cables = with_elongations(fit.jobs[j].transmission, point.l_o[j]);
    for (const JointRecord& record : fit.jobs[j].records) {
      const std::size_t n = record.equations.size();
      Eigen::Index rows = 1;
      for (std::size_t e = 0; e < n; ++e)
        rows = std::max(rows, direct.blocks[block + e].rows->n_rows());
      const std::string name =
          fit.jobs[j].name +
          (record.equations.front().base.name == "blocked" ? ", blocked" : ", moving");
      take_record(fit, record, cables, name, std::span(direct.blocks).subspan(block, n),
                  rows / n_points + 1, information, trace);
      block += n;
    }
  }
  end_at(fit.layout, estimates, trace);
  return trace;
}

std::vector<Figure> trace_figures(const RecursiveTrace& trace) {
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < trace.names.size(); ++k) {
    Figure figure;
    figure.section = "recursive least squares";
    figure.group = trace.preloads[k];
    figure.title = trace.names[k];
    figure.caption =
        "The estimate after so many rows, with +-2 sd; it ends at that of the direct fit.";
    figure.x = {"rows taken in", ""};
    figure.y = {trace.names[k], trace.units[k]};
    Trace value{"estimate", TraceStyle::line, 1, {}, {}, {}, {}, {}};
    Trace low{"- 2 sd", TraceStyle::dashed, kReference, {}, {}, {}, {}, {}};
    Trace high{"+ 2 sd", TraceStyle::dashed, kReference, {}, {}, {}, {}, {}};
    const TracePoint& end = trace.points.back();
    for (const TracePoint& point : trace.points) {
      // Before an estimate means anything its band would hide the rest.
      if (!(point.sd[k] < 30 * end.sd[k])) continue;
      for (Trace* t : {&value, &low, &high}) t->x.push_back(static_cast<double>(point.n_rows));
      value.y.push_back(point.value[k]);
      low.y.push_back(point.value[k] - 2 * point.sd[k]);
      high.y.push_back(point.value[k] + 2 * point.sd[k]);
    }
    figure.traces = {value, low, high};
    if (!value.x.empty()) figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace cablefit
