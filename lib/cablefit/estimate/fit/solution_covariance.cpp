#include "cablefit/estimate/fit/solution_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cablefit/estimate/solve/cell_places.hpp"
#include "cablefit/estimate/spread/long_run.hpp"

namespace cablefit {

void robust_covariance(const RowStatistics& rows, LinearSolution& out) {
  const Eigen::Index p = out.x.size();
  const auto n_cells = static_cast<Eigen::Index>(rows.cells().size());
  if (n_cells < 8) {
    out.covariance = out.covariance_white;
    out.degrees_of_freedom =
        static_cast<double>(std::max<Eigen::Index>(1, out.n_rows - out.n_params));
    out.effective_rows = static_cast<double>(out.n_rows);
    return;
  }
  // The influence on the parameters, not the raw scores: what counts is the correlation of each
  // estimate's own.
  const Eigen::MatrixXd influence =
      series_over_time(rows.cells(), p, [&](const GramCell& cell) -> Eigen::RowVectorXd {
        const Eigen::VectorXd all = cell.gram * out.residual_combination;
        return (out.solve_operator * (out.score_columns.transpose() * all)).transpose();
      });
  std::vector<Eigen::MatrixXd> information(static_cast<std::size_t>(influence.rows()));
  const std::vector<Eigen::Index> places = cell_places(rows.cells());
  for (std::size_t c = 0; c < places.size(); ++c)
    information[static_cast<std::size_t>(places[c])] =
        out.score_columns.transpose() * rows.cells()[c].gram * out.score_columns;
  const FittedOut fitted = fitted_out(information, out.solve_operator);
  const LongRunCovariance hac = interval_covariance(influence, &fitted);
  const double n = static_cast<double>(out.n_rows);
  const double small_sample = n / std::max(1.0, n - out.n_params);
  out.covariance = small_sample * hac.covariance;
  // No credit for anti-correlated residuals: encoder quantisation looks like that, and what the
  // filter leaves of a bias does not shrink with it.
  for (Eigen::Index k = 0; k < p; ++k) {
    const double white = out.covariance_white(k, k);
    if (out.covariance(k, k) >= white) continue;
    if (!(out.covariance(k, k) > 0)) {  // a kernel cut off is not quite positive
      out.covariance.row(k).setZero();
      out.covariance.col(k).setZero();
      out.covariance(k, k) = white;
      continue;
    }
    const double grow = std::sqrt(white / out.covariance(k, k));
    out.covariance.row(k) *= grow;
    out.covariance.col(k) *= grow;
  }
  out.degrees_of_freedom = hac.degrees_of_freedom;
  double inflation = 0;
  int counted = 0;
  for (Eigen::Index k = 0; k < p; ++k) {
    if (!(out.covariance_white(k, k) > 0)) continue;
    inflation += out.covariance(k, k) / out.covariance_white(k, k);
    ++counted;
  }
  out.effective_rows = counted > 0 && inflation > 0 ? n * counted / inflation : n;
}

void widen_beside_bounds(LinearSolution& out) {
  if (std::none_of(out.at_bound.begin(), out.at_bound.end(), [](bool b) { return b; })) return;
  for (Eigen::Index k = 0; k < out.x.size(); ++k) {
    const double variance = out.unbounded_sd(k) * out.unbounded_sd(k);
    if (!(out.covariance(k, k) > 0) || variance <= out.covariance(k, k)) continue;
    const double grow = std::sqrt(variance / out.covariance(k, k));
    out.covariance.row(k) *= grow;
    out.covariance.col(k) *= grow;
  }
}

}  // namespace cablefit
