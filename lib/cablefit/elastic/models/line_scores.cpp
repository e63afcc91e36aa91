#include "cablefit/elastic/models/line_scores.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kFewestScoredRows = 10;

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

std::string range_text(const std::pair<double, double>& range, Axes axes) {
  return fmt::format("{:.4g} .. {:.4g} {}", 1e3 * range.first, 1e3 * range.second,
                     unit_for(axes, "mrad"));
}

/// The rows with deflections in the range.
BlockedRows rows_within(const BlockedRows& rows, const std::pair<double, double>& range,
                        Axes axes) {
  const Eigen::Index phi = rows.columns.deflection;
  BlockedRows within = rows_where(rows, [&](const Eigen::Ref<const Eigen::RowVectorXd>& row) {
    return row(phi) >= range.first && row(phi) <= range.second;
  });
  if (within.rows->n_rows() < kFewestScoredRows)
    throw Error(
        ErrorKind::input,
        fmt::format("--linear-range: {} samples have a deflection of {}; give a range within {}",
                    within.rows->n_rows(), range_text(range, axes),
                    range_text({rows.deflection_low, rows.deflection_high}, axes)));
  return within;
}

/// The rows less the motor's friction, as the cables' fit has it: a line that bends where the
/// cables do not would take part of it.
BlockedRows without_friction(const BlockedRows& rows, const ElasticCandidate& cables,
                             const LinearSolution& solution) {
  BlockedRows elastic = rows;
  elastic.taken_off = Eigen::VectorXd::Zero(rows.columns.count);
  for (std::size_t k = cables.n_elastic; k < cables.regressors.size(); ++k)
    if (const Eigen::Index column = cables.regressors[k];
        column == rows.columns.direction || column == rows.columns.speed)
      elastic.taken_off(column) = solution.x(static_cast<Eigen::Index>(k));
  return elastic;
}

/// Straight lines through the elastic torque, each with its own offset where that is free.
class Lines {
 public:
  Lines(const BlockedRows& elastic, bool theta_0)
      : elastic_(elastic), nuisance_({theta_0, false, false}) {}

  double slope_of(const BlockedRows& within) const {
    return solve_candidate(within, candidate(within)).x(0);
  }
  Scored with_slope(std::string fitted, double k) const {
    const LinearSolution s = solve_given(elastic_, candidate(elastic_), std::span(&k, 1));
    return {"linear", std::move(fitted), k, s.residual_combination};
  }

 private:
  ElasticCandidate candidate(const BlockedRows& rows) const {
    return linear_candidate(rows, std::span(&nuisance_, 1));
  }

  const BlockedRows& elastic_;
  Nuisance nuisance_;
};

std::vector<Scored> curves_of(const ElasticJob& job, const BlockedRows& rows,
                              const ElasticPreload& preload, const ElasticCandidate& cables,
                              const LinearSolution& solution) {
  const BlockedRows elastic = without_friction(rows, cables, solution);
  const Lines lines(elastic, find_estimate(preload.fits.back().parameters, "theta_0") != nullptr);
  const Axes axes = job.rig().axes.all();
  const double fitted = preload.fits.front().transmission.linear_stiffness(0);
  std::vector<Scored> curves = {lines.with_slope("all samples", fitted)};
  for (const std::pair<double, double>& range : job.options.lines.ranges)
    curves.push_back(lines.with_slope(range_text(range, axes),
                                      lines.slope_of(rows_within(elastic, range, axes))));
  for (const double k : job.options.lines.stiffnesses)
    curves.push_back(lines.with_slope("given", k));
  curves.push_back({model_text(preload.fits.back()), "all samples",
                    std::numeric_limits<double>::quiet_NaN(), solution.residual_combination});
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
                                       const ElasticPreload& preload,
                                       const ElasticCandidate& cables,
                                       const LinearSolution& solution) {
  std::vector<ElasticScore> scores;
  if (job.options.lines.empty()) return scores;
  const std::vector<Scored> curves = curves_of(job, rows, preload, cables, solution);
  for (const Scored& curve : curves) scores.push_back(score_of(curve, rows, false));
  if (job.options.lines.test.empty()) return scores;
  const BlockedRows test = test_rows(job, rows, preload.name);
  for (const Scored& curve : curves) scores.push_back(score_of(curve, test, true));
  return scores;
}

}  // namespace cablefit
