#include "cablefit/dynamic/estimators/online_traces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/estimators/least_squares_fit.hpp"
#include "cablefit/dynamic/estimators/online_system.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit::estimation {
namespace {

constexpr Eigen::Index kPoints = 200;    // of a trace
constexpr double kDefaultShare = 0.1;    // of the logs: memory of the gradient
constexpr double kRowsPerParameter = 2;  // the least a memory holds

/// s between the rows that are fitted.
double row_period(const DynamicJob& job) {
  return job.settings.rows.decimate * job.first_part().period;
}

Eigen::Index most_rows(const EstimationTask& task) {
  Eigen::Index most = 0;
  for (const EquationRows& e : task.equations) most = std::max(most, e.rows->n_rows());
  return most;
}

/// The most that one system has.
Eigen::Index most_parameters(const EstimationTask& task) {
  Eigen::Index most = 1;
  for (const EquationRows& e : task.equations)
    most = std::max(most, static_cast<Eigen::Index>(e.columns.parameters.size()));
  return most;
}

void require_memory(double memory, double least) {
  if (memory >= least) return;
  throw usage_error(fmt::format("--memory {:.3g} is too short: the parameters of one equation need "
                                "{:.2g} s of samples",
                                memory, least),
                    "give a longer memory");
}

/// 0: forgets nothing.
double memory_of(const EstimationTask& task, OnlineMethod method) {
  const double least =
      kRowsPerParameter * static_cast<double>(most_parameters(task)) * row_period(task.job);
  const double given = task.job.options.memory;
  if (given > 0) {
    require_memory(given, least);
    return given;
  }
  if (method == OnlineMethod::recursive) return 0;
  return std::max(least,
                  kDefaultShare * static_cast<double>(most_rows(task)) * row_period(task.job));
}

OnlineRule rule_of(const EstimationTask& task, OnlineMethod method) {
  OnlineRule rule;
  rule.memory = memory_of(task, method);
  if (method == OnlineMethod::recursive) {
    if (rule.memory > 0) rule.forgetting = forgetting_factor(rule.memory / row_period(task.job));
    return rule;
  }
  rule.method = "gradient";
  return rule;
}

/// Time over all logs, one after the other.
class TraceClock {
 public:
  /// Rows of a log begin or go on at `t` of its own time.
  void begin(std::size_t log, double t) {
    if (log != log_) shift_ = log_ == kNoLog ? 0 : last_ - t;
    log_ = log;
  }
  double at(double t) { return last_ = shift_ + t; }

 private:
  static constexpr std::size_t kNoLog = static_cast<std::size_t>(-1);
  std::size_t log_ = kNoLog;
  double shift_ = 0, last_ = 0;
};

/// One method on all systems of the task.
struct Online {
  std::vector<OnlineSystem> systems;
  RecursiveTrace trace;

  Online(const EstimationTask& task, const Estimation& direct, const OnlineRule& rule) {
    for (const std::vector<std::size_t>& equations : systems_of(task.equations))
      systems.emplace_back(task, equations, direct, rule, rule.memory / row_period(task.job));
    trace.rule = rule;
    for (const OnlineSystem& system : systems) {
      trace.rule.step = std::max(trace.rule.step, system.step());
      if (system.step() > 0)
        trace.rule.slowest = std::max(trace.rule.slowest, system.slowest() * rule.memory);
    }
    for (const Estimate& e : direct.fit.parameters) {
      trace.names.push_back(e.name);
      trace.preloads.push_back(task.job.preload);
      trace.units.push_back(e.unit);
    }
  }

  /// What is known of all systems, in the order of the parameters.
  void add_point(const std::string& record, double t) {
    TracePoint point;
    point.record = record;
    point.t = t;
    for (const OnlineSystem& system : systems) {
      const TracePoint own = system.point(record);
      point.n_rows += own.n_rows;
      point.value.insert(point.value.end(), own.value.begin(), own.value.end());
      point.sd.insert(point.sd.end(), own.sd.begin(), own.sd.end());
    }
    trace.points.push_back(std::move(point));
  }
};

/// From the first to behind the last row of any equation.
GridSpan span_of(const RowBatch& batch) {
  GridSpan span{std::numeric_limits<Eigen::Index>::max(), 0};
  for (const EquationBatch& e : batch.equations) {
    if (e.numbers.empty()) continue;
    span.first = std::min(span.first, e.numbers.front());
    span.last = std::max(span.last, e.numbers.back() + 1);
  }
  return span;
}

/// s, of the log: of the first row of any equation.
double first_time(const RowBatch& batch) {
  double t = std::numeric_limits<double>::infinity();
  for (const EquationBatch& e : batch.equations)
    if (!e.t.empty()) t = std::min(t, e.t.front());
  return t;
}

/// s, of the log: of the last row before the end of the span.
double time_at_end(const RowBatch& batch, const GridSpan& span) {
  double t = 0;
  for (const EquationBatch& e : batch.equations) {
    const auto end = std::lower_bound(e.numbers.begin(), e.numbers.end(), span.last);
    if (end != e.numbers.begin())
      t = std::max(t, e.t[static_cast<std::size_t>(end - e.numbers.begin()) - 1]);
  }
  return t;
}

void stream_into(const EstimationTask& task, std::vector<Online>& all) {
  std::vector<Equation> plain;
  for (const EquationRows& e : task.equations) plain.push_back(e.equation);
  const Eigen::Index step = most_rows(task) / kPoints + 1;
  const DynamicJob& job = task.job;
  TraceClock clock;
  stream_rows(
      job.logs, job.wanted, job.settings.rows, plain, job.options.samples.threads,
      [](RowBatch batch) { return batch; },
      [&](const RowBatch& batch) {
        const std::string record =
            std::filesystem::path(job.logs[batch.log].plan.path).filename().string();
        const GridSpan whole = span_of(batch);
        if (whole.first < whole.last) clock.begin(batch.log, first_time(batch));
        for (Eigen::Index first = whole.first; first < whole.last; first += step) {
          const GridSpan span{first, std::min(first + step, whole.last)};
          const double t = clock.at(time_at_end(batch, span));
          for (Online& online : all) {
            Eigen::Index n = 0;
            for (OnlineSystem& system : online.systems) n += system.take(batch, span);
            if (n > 0) online.add_point(record, t);
          }
        }
      });
}

Decision decision_of(const OnlineRule& rule, const EstimationTask& task, bool given) {
  const double samples = rule.memory / row_period(task.job);
  const std::string seconds = fmt::format("{:.3g} s", rule.memory);
  const std::string origin = given ? "given" : "a tenth of the logs";
  if (rule.method == "gradient")
    return {"memory of the gradient", seconds,
            fmt::format("{}: {:.0f} samples; step {:.3g} of a bound of 2{}; the slowest direction "
                        "takes {:.3g} s",
                        origin, samples, rule.step, rule.step == 1 ? ", limited to 1" : "",
                        rule.slowest)};
  if (rule.memory == 0)
    return {"memory of the recursive estimate", "all", "every row counts the same"};
  return {"memory of the recursive estimate", seconds,
          fmt::format("{}: {:.0f} samples, forgetting factor {:.6g}; as certain as {:.0f} samples "
                      "of one weight",
                      origin, samples, rule.forgetting, equivalent_samples(rule.forgetting))};
}

/// The sd of the gradient is that of the steady state; empty: it came there.
std::string why_not_settled(const RecursiveTrace& trace) {
  constexpr double kTimeConstants = 3;
  const double seconds = trace.points.empty() ? 0 : trace.points.back().t;
  if (trace.rule.method != "gradient" || kTimeConstants * trace.rule.slowest <= seconds) return "";
  return fmt::format(
      "the gradient estimate did not converge: its slowest direction takes {:.3g} s and the "
      "logs last {:.3g} s; its sd, of the steady state, is too small; give a shorter --memory, "
      "or longer logs",
      trace.rule.slowest, seconds);
}

}  // namespace

Estimation with_traces(const EstimationTask& task, std::span<const OnlineMethod> methods) {
  Estimation out = least_squares_fit(task, Weighting::by_residual);
  std::vector<Online> all;
  for (const OnlineMethod method : methods) all.emplace_back(task, out, rule_of(task, method));
  stream_into(task, all);
  for (Online& online : all) {
    RecursiveTrace& trace = online.trace;
    if (trace.rule.memory > 0)
      scale_bands(out.fit.parameters, trace);
    else
      end_at(out.fit.parameters, trace);
    out.decisions.push_back(decision_of(trace.rule, task, task.job.options.memory > 0));
    if (std::string why = why_not_settled(trace); !why.empty())
      out.fit.warnings.push_back(std::move(why));
    out.fit.traces.push_back(std::move(trace));
  }
  return out;
}

}  // namespace cablefit::estimation
