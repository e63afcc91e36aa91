#include "cablefit/elastic/line_scores.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kMinRows = 10;

/// A model on its way to its scores.
struct Scored {
  std::string model, fitted;
  double stiffness = 0;      ///< NaN of cables
  Eigen::VectorXd residual;  ///< combination of the rows' columns
};

struct Errors {
  double squares = 0, n = 0, largest = 0, at = 0;

  void add(const Eigen::VectorXd& errors, const Eigen::VectorXd& deflections) {
    Eigen::Index worst = 0;
    squares += errors.squaredNorm();
    n += static_cast<double>(errors.size());
    if (errors.size() == 0 || errors.cwiseAbs().maxCoeff(&worst) <= largest) return;
    largest = std::abs(errors(worst));
    at = deflections(worst);
  }
};

ElasticScore score_of(const Scored& curve, const BlockedRows& rows, bool is_test) {
  Errors errors;
  rows.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index>) {
    errors.add(r * curve.residual, r.col(rows.columns.deflection));
  });
  return {curve.model,
          curve.fitted,
          curve.stiffness,
          is_test,
          std::sqrt(errors.squares / std::max(1.0, errors.n)),
          errors.largest,
          errors.at};
}

std::string range_text(const std::pair<double, double>& range, bool linear_motion) {
  return fmt::format("{:.4g} .. {:.4g} {}", 1e3 * range.first, 1e3 * range.second,
                     linear_motion ? "mm" : "mrad");
}

/// The rows with deflections in the range.
BlockedRows rows_within(const BlockedRows& rows, const std::pair<double, double>& range,
                        bool linear_motion) {
  BlockedRows within = rows;
  within.rows = rows.rows->empty_copy();
  rows.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index> numbers) {
    std::vector<Eigen::Index> kept, kept_numbers;
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      const double phi = r(i, rows.columns.deflection);
      if (phi < range.first || phi > range.second) continue;
      kept.push_back(i);
      kept_numbers.push_back(numbers[static_cast<std::size_t>(i)]);
    }
    if (!kept.empty()) within.rows->add(r(kept, Eigen::all), kept_numbers);
  });
  if (within.rows->n_rows() < kMinRows)
    throw Error(
        ErrorKind::input,
        fmt::format("--linear-range: {} samples have a deflection of {}; give a range within {}",
                    within.rows->n_rows(), range_text(range, linear_motion),
                    range_text({rows.deflection_low, rows.deflection_high}, linear_motion)));
  return within;
}

std::vector<Scored> curves_of(const ElasticJob& job, const BlockedRows& rows,
                              std::span<const Nuisance> nuisance, const ElasticPreload& preload,
                              std::span<const LinearSolution> solutions) {
  std::vector<Scored> curves;
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    const ElasticFit& fit = preload.fits[k];
    const bool is_line = fit.model == "linear";
    const double stiffness = is_line ? solutions[k].x(0) : std::numeric_limits<double>::quiet_NaN();
    curves.push_back({is_line ? "linear" : fmt::format("poly, order {}", fit.order), "all samples",
                      stiffness, solutions[k].residual_combination});
  }
  const auto add_line = [&](std::string fitted, const LinearSolution& s) {
    curves.push_back({"linear", std::move(fitted), s.x(0), s.residual_combination});
  };
  const bool linear_motion = job.rig().linear_motion;
  for (const std::pair<double, double>& range : job.options.lines.ranges) {
    const BlockedRows within = rows_within(rows, range, linear_motion);
    add_line(range_text(range, linear_motion),
             solve_candidate(within, linear_candidate(within, nuisance)));
  }
  for (const double k : job.options.lines.stiffnesses)
    add_line("given", solve_given(rows, linear_candidate(rows, nuisance), std::span(&k, 1)));
  return curves;
}

/// Rows of the test logs, by the columns that the curves were fitted to.
BlockedRows test_rows(const ElasticJob& job, const BlockedRows& rows, const std::string& preload) {
  ElasticJob test = job;
  test.logs = job.options.lines.test;
  for (const LogSurvey& log : test.logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part))
        return collect_blocked(test, rows.transmission.encoder_zero()(0), nullptr);
  throw input_error({test.logs.front().plan.path, 0, 0},
                    fmt::format("--test has no blocked log of preload '{:.40}'", preload),
                    "give one, or choose a preload of the test logs with --preload");
}

}  // namespace

std::vector<ElasticScore> score_curves(const ElasticJob& job, const BlockedRows& rows,
                                       std::span<const Nuisance> nuisance,
                                       const ElasticPreload& preload,
                                       std::span<const LinearSolution> solutions) {
  std::vector<ElasticScore> scores;
  if (job.options.lines.empty()) return scores;
  const std::vector<Scored> curves = curves_of(job, rows, nuisance, preload, solutions);
  for (const Scored& curve : curves) scores.push_back(score_of(curve, rows, false));
  if (job.options.lines.test.empty()) return scores;
  const BlockedRows test = test_rows(job, rows, preload.name);
  for (const Scored& curve : curves) scores.push_back(score_of(curve, test, true));
  return scores;
}

}  // namespace cablefit
