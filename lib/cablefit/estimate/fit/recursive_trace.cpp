#include "cablefit/estimate/fit/recursive_trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cablefit {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

RecursiveInformation::RecursiveInformation(const std::vector<std::string>& names,
                                           Eigen::MatrixXd equalities)
    : seen_(static_cast<Eigen::Index>(names.size()) + 1, 1, false) {
  const auto p = static_cast<Eigen::Index>(names.size());
  problem_.names = names;
  problem_.equalities = std::move(equalities);
  JointBlock block;
  block.regressors = Eigen::MatrixXd::Identity(p + 1, p);
  block.response = Eigen::VectorXd::Unit(p + 1, p);
  problem_.blocks = {block};
}

void RecursiveInformation::add(const JointBlock& block,
                               const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  Eigen::MatrixXd weighted(rows.rows(), block.regressors.cols() + 1);
  weighted << rows * block.regressors, rows * block.response;
  weighted *= std::sqrt(block.weight);
  const std::vector<Eigen::Index> numbers(static_cast<std::size_t>(rows.rows()), 0);
  seen_.add(weighted, numbers);
}

TracePoint RecursiveInformation::point(const std::string& record) const {
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

void end_at(std::span<const Estimate> estimates, RecursiveTrace& trace) {
  if (trace.points.empty()) return;
  const std::vector<double> last = trace.points.back().sd;
  for (TracePoint& point : trace.points)
    for (std::size_t k = 0; k < last.size(); ++k) {
      const Estimate& e = estimates[k];
      if (!e.not_identifiable.empty()) point.value[k] = kNone;
      const bool has_band = e.not_identifiable.empty() && e.active_bound.empty() && last[k] > 0;
      point.sd[k] = has_band ? point.sd[k] * e.sd / last[k] : kNone;
    }
}

std::vector<Figure> trace_figures(const RecursiveTrace& trace) {
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < trace.names.size(); ++k) {
    Figure figure;
    figure.section = "recursive least squares";
    figure.group = trace.preloads[k];
    figure.title = trace.names[k];
    figure.rank = FigureRank::detail;
    figure.caption =
        "Estimate after each row, with +-2 sd. The last value is that of the direct "
        "fit.";
    figure.x = {"rows read", ""};
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
