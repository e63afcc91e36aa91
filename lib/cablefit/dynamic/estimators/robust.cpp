// Huber's M-estimate: weighted least squares on residuals pulled in to what noise explains,
// iterated until it stands still; then the stretches of time that it did not believe.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/dynamic/estimators/least_squares_fit.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"
#include "cablefit/estimate/fit/huber.hpp"
#include "cablefit/samples/rows/row_archive.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit::estimation {
namespace {

constexpr int kMostSteps = 50;
constexpr double kStandsStill = 1e-5;  // of an sd
constexpr double kSameScale = 1e-3;    // relative: what the bins of the median leave open
constexpr double kFirstGuess = 4;      // times the rms: where the median is looked for at first
constexpr double kNextGuess = 8;       // times the scale before
constexpr std::size_t kMostSpans = 50;

using Archives = std::vector<std::unique_ptr<RowArchive>>;

std::vector<Equation> plain(const std::vector<EquationRows>& equations) {
  std::vector<Equation> all;
  for (const EquationRows& e : equations) all.push_back(e.equation);
  return all;
}

Archives archive_rows(const EstimationTask& task) {
  Archives archives;
  for (std::size_t k = 0; k < task.equations.size(); ++k)
    archives.push_back(std::make_unique<RowArchive>());
  stream_rows(
      task.job.logs, task.job.wanted, task.job.settings.rows, plain(task.equations),
      task.job.options.samples.threads, [](RowBatch batch) { return batch; },
      [&](const RowBatch& batch) {
        for (std::size_t k = 0; k < archives.size(); ++k) archives[k]->append(batch.equations[k]);
      });
  return archives;
}

/// sd of the residuals that outliers do not move, by the median of their magnitudes.
double robust_scale(const RowArchive& rows, const Eigen::VectorXd& combination, double guess) {
  AbsoluteMedian median(guess);
  rows.for_each([&](const Eigen::MatrixXd& batch, std::span<const Eigen::Index>) {
    for (const double r : Eigen::VectorXd(batch * combination)) median.add(r);
  });
  return median.normal_sd();
}

double inlier_share(const RowArchive& rows, const Eigen::VectorXd& combination,
                    const Huber& huber) {
  double inliers = 0, n = 0;
  rows.for_each([&](const Eigen::MatrixXd& batch, std::span<const Eigen::Index>) {
    for (const double r : Eigen::VectorXd(batch * combination)) inliers += huber.is_inlier(r);
    n += static_cast<double>(batch.rows());
  });
  return n > 0 ? inliers / n : 1;
}

/// The rows of an equation as pulled in by the last fit.
void pull_in_rows(const RowArchive& rows, const Eigen::VectorXd& combination, const Huber& huber,
                  EquationRows& e) {
  RowStatistics pulled = e.rows->empty_copy();
  const double share = inlier_share(rows, combination, huber);
  Eigen::MatrixXd changed;
  rows.for_each([&](const Eigen::MatrixXd& batch, std::span<const Eigen::Index> numbers) {
    changed = batch;
    pull_in(huber, share, combination, e.columns.torque, changed);
    pulled.add(changed, numbers);
  });
  e.rows = std::move(pulled);
}

struct Iteration {
  Estimation estimation;
  std::vector<Huber> hubers;  ///< per equation
  bool is_still = false;
};

/// One step from `from`; `pulled`: the equations with the rows to be replaced.
Iteration step(const EstimationTask& task, const Archives& archives, const Iteration& from,
               std::vector<EquationRows>& pulled) {
  Iteration next;
  for (std::size_t k = 0; k < pulled.size(); ++k) {
    const LinearSolution& last = from.estimation.solutions[k];
    const double guess =
        from.hubers.empty() ? kFirstGuess * last.rms() : kNextGuess * from.hubers[k].scale;
    Huber huber{robust_scale(*archives[k], last.residual_combination, guess)};
    if (!from.hubers.empty() &&
        std::abs(huber.scale - from.hubers[k].scale) <= kSameScale * huber.scale)
      huber = from.hubers[k];
    next.hubers.push_back(huber);
    pull_in_rows(*archives[k], last.residual_combination, next.hubers[k], pulled[k]);
  }
  next.estimation = least_squares_fit({task.job, pulled, task.model}, Weighting::by_residual);
  next.is_still = !from.hubers.empty();
  for (std::size_t k = 0; k < pulled.size(); ++k)
    next.is_still =
        next.is_still && largest_change_in_sd(from.estimation.solutions[k],
                                              next.estimation.solutions[k]) < kStandsStill;
  return next;
}

/// Where spans of one equation come from: rows of a log that stick out, in order.
class SpanCollector {
 public:
  SpanCollector(std::string equation, double bridge)
      : equation_(std::move(equation)), bridge_(bridge) {}

  void add(const LogSurvey& log, std::size_t part, double t, double residual) {
    const bool follows =
        !spans_.empty() && log_ == &log && part_ == part && t - spans_.back().to <= bridge_;
    if (!follows) {
      spans_.push_back({equation_, std::filesystem::path(log.plan.path).filename().string(),
                        log.parts[part].run, t, t, 0, 0});
      log_ = &log;
      part_ = part;
    }
    SuspectSpan& span = spans_.back();
    span.to = t;
    ++span.n_rows;
    if (std::abs(residual) > std::abs(span.largest)) span.largest = residual;
  }
  const std::vector<SuspectSpan>& spans() const { return spans_; }

 private:
  std::string equation_;
  double bridge_;
  const LogSurvey* log_ = nullptr;
  std::size_t part_ = 0;
  std::vector<SuspectSpan> spans_;
};

std::vector<SuspectSpan> suspect_spans(const EstimationTask& task, const Iteration& last) {
  const DynamicJob& job = task.job;
  // A single wrong sample rings in the filter for as long as edges are dropped.
  const RowSettings& rows = job.settings.rows;
  const double bridge = static_cast<double>(rows.drop_edge) / rows.rate;
  std::vector<SpanCollector> collectors;
  for (const EquationRows& e : task.equations) collectors.emplace_back(e.equation.name, bridge);
  stream_rows(
      job.logs, job.wanted, job.settings.rows, plain(task.equations), job.options.samples.threads,
      [](RowBatch batch) { return batch; },
      [&](const RowBatch& batch) {
        for (std::size_t k = 0; k < collectors.size(); ++k) {
          const EquationBatch& e = batch.equations[k];
          const Eigen::VectorXd r = e.rows * last.estimation.solutions[k].residual_combination;
          const double limit =
              suspect_limit(task.equations[k].counts.rows_used) * last.hubers[k].scale;
          for (Eigen::Index i = 0; i < r.size(); ++i)
            if (std::abs(r(i)) > limit)
              collectors[k].add(job.logs[batch.log], batch.part, e.t[static_cast<std::size_t>(i)],
                                r(i));
        }
      });
  std::vector<SuspectSpan> all;
  for (const SpanCollector& one : collectors)
    all.insert(all.end(), one.spans().begin(), one.spans().end());
  return all;
}

void keep_largest(std::vector<SuspectSpan>& spans, std::vector<std::string>& warnings) {
  if (spans.empty()) return;
  warnings.push_back(
      fmt::format("{} stretch{} of time exceed{} the noise and get{} little weight: see the "
                  "suspect spans",
                  spans.size(), spans.size() == 1 ? "" : "es", spans.size() == 1 ? "s" : "",
                  spans.size() == 1 ? "s" : ""));
  if (spans.size() <= kMostSpans) return;
  std::nth_element(spans.begin(), spans.begin() + kMostSpans, spans.end(),
                   [](const SuspectSpan& a, const SuspectSpan& b) {
                     return std::abs(a.largest) > std::abs(b.largest);
                   });
  spans.resize(kMostSpans);
  std::sort(spans.begin(), spans.end(), [](const SuspectSpan& a, const SuspectSpan& b) {
    return std::tie(a.equation, a.log, a.from) < std::tie(b.equation, b.log, b.from);
  });
}

Estimation estimate_robustly(const EstimationTask& task) {
  const Archives archives = archive_rows(task);
  std::vector<EquationRows> pulled = task.equations;
  Iteration last{least_squares_fit(task, Weighting::by_residual), {}, false};
  for (int k = 0; k < kMostSteps && !last.is_still; ++k) last = step(task, archives, last, pulled);
  Estimation out = last.estimation;
  if (!last.is_still)
    out.fit.warnings.push_back(
        fmt::format("the robust fit did not converge in {} iterations", kMostSteps));
  for (std::size_t k = 0; k < task.equations.size(); ++k)  // of the rows as they are
    add_errors(*task.equations[k].rows, task.equations[k].equation.name, out.solutions[k], out.fit);
  out.fit.suspects = suspect_spans(task, last);
  keep_largest(out.fit.suspects, out.fit.warnings);
  return out;
}

}  // namespace

Estimator robust() {
  return {"robust",
          "Huber's M-estimate: outliers get less weight, suspect stretches of time are "
          "listed",
          "Huber 1981, ch. 7 (c = 1.345, scale by the median)", estimate_robustly};
}

}  // namespace cablefit::estimation
