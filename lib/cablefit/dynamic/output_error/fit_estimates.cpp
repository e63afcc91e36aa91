#include "cablefit/dynamic/output_error/fit_estimates.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/estimate/spread/long_run.hpp"

namespace cablefit {
namespace {

/// With r whitened, J'J is the information; the robust covariance puts the long-run covariance of
/// the scores, cell by cell, in its middle (see least_squares.hpp).
void fill_covariance(const FinalRows& last, OutputErrorFit& fit) {
  const RowStatistics& statistics = last.pass.statistics;
  const Eigen::Index p = last.solution.x.size();
  const double variance = fit.residual_rms * fit.residual_rms;
  const Eigen::MatrixXd prior = last.prior.leftCols(p);
  const Eigen::MatrixXd& inverse = last.solution.inverse;
  const Eigen::MatrixXd of_prior = inverse * (prior.transpose() * prior) * inverse;
  fit.covariance_white = variance * (inverse - of_prior) + of_prior;
  fit.covariance = fit.covariance_white;
  fit.degrees_of_freedom = static_cast<double>(statistics.n_rows() - p);
  fit.effective_rows = static_cast<double>(statistics.n_rows());
  const auto n_cells = static_cast<Eigen::Index>(statistics.cells().size());
  if (n_cells < 8) return;
  const Eigen::MatrixXd scores =
      series_over_time(statistics.cells(), p, [p](const GramCell& cell) -> Eigen::RowVectorXd {
        return cell.gram.col(p).head(p).transpose();
      });
  const LongRunCovariance hac = interval_covariance(scores * inverse);
  fit.covariance = hac.covariance + of_prior;
  fit.degrees_of_freedom = hac.degrees_of_freedom;
  double ratio = 0, n = 0;
  for (Eigen::Index k = 0; k < p; ++k) {  // no credit for anti-correlated residuals
    const double white = fit.covariance_white(k, k), robust = fit.covariance(k, k);
    if (!(white > 0)) continue;
    if (robust < white) {
      fit.covariance.row(k) *= robust > 0 ? std::sqrt(white / robust) : 0;
      fit.covariance.col(k) *= robust > 0 ? std::sqrt(white / robust) : 0;
      fit.covariance(k, k) = white;
    }
    ratio += fit.covariance(k, k) / white;
    ++n;
  }
  if (n > 0) fit.effective_rows *= n / ratio;
}

/// One-sided, by the profile of the whitened |r|^2, as far as the fit is linear there: c beyond the
/// bound costs ((c - f)^2 - f^2) / sd^2 when the parameter would go to f <= 0 if it were free. With
/// its column last among those that are free, the last row of R says that alone.
void set_on_bound(const FinalRows& last_rows, std::size_t k, const OutputErrorFit& fit,
                  Estimate& e) {
  const NonlinearSolution& solution = last_rows.solution;
  std::vector<Eigen::Index> columns;
  for (std::size_t j = 0; j < solution.at_bound.size(); ++j)
    if (!solution.at_bound[j] && solution.not_identifiable[j].empty())
      columns.push_back(static_cast<Eigen::Index>(j));
  columns.push_back(static_cast<Eigen::Index>(k));
  columns.push_back(solution.x.size());
  const auto last = static_cast<Eigen::Index>(columns.size()) - 2;
  StreamingQr all(solution.x.size() + 1);
  all.add(last_rows.pass.statistics.r());
  if (last_rows.prior.rows() > 0) all.add(last_rows.prior);
  const Eigen::MatrixXd rows = all.r()(Eigen::all, columns);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  const double slope = qr.matrixQR()(last, last);
  e.sd_white = fit.residual_rms / std::abs(slope);
  e.sd = e.sd_white * std::sqrt(static_cast<double>(fit.n_rows) / fit.effective_rows);
  const double free = std::min(0.0, -qr.matrixQR()(last, last + 1) / slope);
  e.ci_low = e.value;
  e.ci_high = e.value + free + std::hypot(free, t_quantile_975(fit.degrees_of_freedom) * e.sd);
  e.profiled = true;
}

Estimate estimate_of(const FinalRows& last, std::size_t k, const OutputErrorFit& fit) {
  const NonlinearSolution& solution = last.solution;
  const ModelParameter& p = last.parameters[k];
  const auto i = static_cast<Eigen::Index>(k);
  Estimate e;
  e.name = p.name;
  e.symbol = p.symbol;
  e.unit = p.unit;
  e.not_identifiable = solution.not_identifiable[k];
  if (!e.not_identifiable.empty()) return e;
  e.value = solution.x[i];
  if (solution.at_bound[k] && is_inertia(fit.model, p)) {
    e.not_identifiable = fmt::format("its estimate tends to 0: the fit stopped at {:.3g}", e.value);
    e.value = std::numeric_limits<double>::quiet_NaN();
    return e;
  }
  if (solution.at_bound[k]) {
    const bool is_upper = e.value - p.lower > p.upper - e.value;
    e.active_bound =
        fmt::format("{} {} {:g}", p.name, is_upper ? "<=" : ">=", is_upper ? p.upper : p.lower);
    set_on_bound(last, k, fit, e);
    return e;
  }
  e.sd_white = std::sqrt(fit.covariance_white(i, i));
  e.sd = std::sqrt(fit.covariance(i, i));
  set_interval(e, fit.degrees_of_freedom, p.lower);
  return e;
}

}  // namespace

void fill_estimates(const FinalRows& last, OutputErrorFit& fit) {
  const RowStatistics& statistics = last.pass.statistics;
  const Eigen::Index p = last.solution.x.size();
  fit.residual_rms =
      statistics.r().col(p).norm() / std::sqrt(static_cast<double>(statistics.n_rows() - p));
  fit.correlation = last.pass.correlation();
  fill_covariance(last, fit);
  for (std::size_t k = 0; k < last.parameters.size(); ++k)
    fit.parameters.push_back(estimate_of(last, k, fit));
}

}  // namespace cablefit
