#include "cablefit/estimate/fit/recursive_trace.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/parameter.hpp"

namespace cablefit {
double forgetting_factor(double memory_samples) { return 1 - 1 / memory_samples; }

double equivalent_samples(double forgetting) { return (1 + forgetting) / (1 - forgetting); }

RecursiveInformation::RecursiveInformation(const std::vector<std::string>& names,
                                           Eigen::MatrixXd equalities)
    : seen_(static_cast<Eigen::Index>(names.size()) + 1, 1, false), squared_(seen_.empty_copy()) {
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
  add(block, rows, Eigen::VectorXd::Ones(rows.rows()));
}

void RecursiveInformation::add(const JointBlock& block,
                               const Eigen::Ref<const Eigen::MatrixXd>& rows,
                               const Eigen::Ref<const Eigen::VectorXd>& weights) {
  Eigen::MatrixXd weighted(rows.rows(), block.regressors.cols() + 1);
  weighted << rows * block.regressors, rows * block.response;
  weighted *= std::sqrt(block.weight);
  const std::vector<Eigen::Index> numbers(static_cast<std::size_t>(rows.rows()), 0);
  forgets_ = forgets_ || (weights.array() != 1).any();
  seen_.add(weights.cwiseSqrt().asDiagonal() * weighted, numbers);
  squared_.add(weights.asDiagonal() * weighted, numbers);
}

void RecursiveInformation::forget(double factor) {
  const auto times = [](const RowStatistics& rows, double weight) {
    const RowStatistics* const one[] = {&rows};
    const double weights[] = {weight};
    return RowStatistics::weighted(one, weights);
  };
  forgets_ = forgets_ || factor != 1;
  seen_ = times(seen_, factor);
  squared_ = times(squared_, factor * factor);
}

Eigen::VectorXd RecursiveInformation::variances(const JointSolution& s) const {
  if (!forgets_) return s.solve_operator.diagonal();
  const Eigen::MatrixXd half = squared_.r().leftCols(s.x.size()) * s.solve_operator;
  return half.colwise().squaredNorm();
}

TracePoint RecursiveInformation::point(const std::string& record) const {
  JointProblem problem = problem_;
  problem.blocks.front().rows = &seen_;
  const JointSolution s = solve(problem);
  const Eigen::VectorXd variance = variances(s);
  TracePoint out{static_cast<std::size_t>(seen_.n_rows()), record, {}, {}};
  for (Eigen::Index k = 0; k < s.x.size(); ++k) {
    const bool known = s.determines(Eigen::VectorXd::Unit(s.x.size(), k)) &&
                       s.n_rows > s.n_params && seen_.r().col(k).norm() > 0;
    out.value.push_back(known ? s.x(k) : kNotKnown);
    out.sd.push_back(known ? std::sqrt(std::max(0.0, variance(k))) : kNotKnown);
  }
  return out;
}

void end_at(std::span<const Estimate> estimates, RecursiveTrace& trace) {
  if (trace.points.empty()) return;
  const std::vector<double> last = trace.points.back().sd;
  for (TracePoint& point : trace.points)
    for (std::size_t k = 0; k < last.size(); ++k) {
      const Estimate& e = estimates[k];
      if (!e.not_identifiable.empty()) point.value[k] = kNotKnown;
      const bool has_band = e.not_identifiable.empty() && e.active_bound.empty() && last[k] > 0;
      point.sd[k] = has_band ? point.sd[k] * e.sd / last[k] : kNotKnown;
    }
}

void scale_bands(std::span<const Estimate> estimates, RecursiveTrace& trace) {
  for (TracePoint& point : trace.points)
    for (std::size_t k = 0; k < point.sd.size(); ++k) {
      const Estimate& e = estimates[k];
      if (!e.not_identifiable.empty()) point.value[k] = kNotKnown;
      const bool has_band = e.not_identifiable.empty() && e.active_bound.empty() && e.sd_white > 0;
      point.sd[k] = has_band ? point.sd[k] * e.sd / e.sd_white : kNotKnown;
    }
}

OnlineEnd online_end(const RecursiveTrace& trace, std::size_t k, const Estimate& direct) {
  if (trace.points.empty()) return {kNotKnown, kNotKnown, kNotKnown};
  const double value = trace.points.back().value[k], sd = trace.points.back().sd[k];
  return {value, sd, sd > 0 ? (value - direct.value) / sd : kNotKnown};
}

namespace {

constexpr double kWideBand = 30;  // times that at the end: it would hide the rest

/// The estimate and its band, from where that means something.
void add_trace(const RecursiveTrace& trace, std::size_t k, int series, const std::string& method,
               Figure& figure) {
  const bool in_time = trace.points.back().t > 0;
  Trace value{method, TraceStyle::line, series, {}, {}, {}, {}, {}};
  Trace low{"- 2 sd", TraceStyle::dashed, kReference, {}, {}, {}, {}, {}};
  Trace high{"+ 2 sd", TraceStyle::dashed, kReference, {}, {}, {}, {}, {}};
  for (const TracePoint& point : trace.points) {
    if (!(point.sd[k] < kWideBand * trace.points.back().sd[k])) continue;
    for (Trace* t : {&value, &low, &high})
      t->x.push_back(in_time ? point.t : static_cast<double>(point.n_rows));
    value.y.push_back(point.value[k]);
    low.y.push_back(point.value[k] - 2 * point.sd[k]);
    high.y.push_back(point.value[k] + 2 * point.sd[k]);
  }
  if (value.x.empty()) return;
  figure.traces.push_back(std::move(value));
  if (series > 1) return;  // bands of the first only
  figure.traces.push_back(std::move(low));
  figure.traces.push_back(std::move(high));
}

Figure blank_trace(const RecursiveTrace& trace, std::size_t k) {
  Figure figure;
  figure.section = "recursive least squares";
  figure.group = trace.preloads[k];
  figure.title = trace.names[k];
  figure.rank = FigureRank::detail;
  figure.x = {"rows read", ""};
  if (trace.points.back().t > 0) figure.x = {"time over all logs", "s"};
  figure.y = {trace.names[k], trace.units[k]};
  return figure;
}

}  // namespace

std::vector<Figure> trace_figures(const RecursiveTrace& trace) {
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < trace.names.size(); ++k) {
    Figure figure = blank_trace(trace, k);
    figure.caption =
        "Estimate after each row, with +-2 sd. The last value is that of the direct fit.";
    add_trace(trace, k, kMeasured, "estimate", figure);
    if (!figure.traces.empty()) figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<Figure> trace_figures(std::span<const RecursiveTrace> traces,
                                  std::span<const Estimate> direct) {
  std::vector<Figure> figures;
  if (traces.empty() || traces.front().points.empty()) return figures;
  for (std::size_t k = 0; k < traces.front().names.size(); ++k) {
    Figure figure = blank_trace(traces.front(), k);
    figure.caption =
        "Estimates after each row against the direct answer from all rows. The band of +-2 sd is "
        "that of the recursive estimate.";
    int series = 0;
    for (const RecursiveTrace& trace : traces)
      add_trace(trace, k, ++series, trace.rule.method, figure);
    if (figure.traces.empty()) continue;
    const std::vector<double>& x = figure.traces.front().x;
    figure.traces.push_back({"direct",
                             TraceStyle::broad,
                             kMeasured,
                             {x.front(), x.back()},
                             {direct[k].value, direct[k].value},
                             {},
                             {},
                             {}});
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace cablefit
