#include "cablefit/estimate/fit/sd_choice.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/spread/bootstrap.hpp"

namespace cablefit {
namespace {

// HAC variance over the white one, less 1: at least, and in sd of the HAC variance.
constexpr double kLeastExcess = 0.1, kExcessSds = 2;
constexpr double kFewEffective = 100;  // effective: below it HAC's intervals are too short
constexpr double kBlockLengths = 5;    // correlation lengths in a block: 10 % of the variance lost
constexpr Eigen::Index kLeastBlocks = 5;
constexpr Eigen::Index kLeastCells = 40;

/// (W'W)^-1 W' rho of every cell: what it adds to each estimate's error.
Eigen::MatrixXd influences(const RowStatistics& rows, const LinearSolution& s) {
  return series_over_time(
      rows.cells(), s.x.size(), [&](const GramCell& cell) -> Eigen::RowVectorXd {
        const Eigen::VectorXd all = cell.gram * s.residual_combination;
        return (s.solve_operator * (s.score_columns.transpose() * all)).transpose();
      });
}

}  // namespace

SdKind ChosenSd::worst() const {
  SdKind worst = SdKind::white;
  for (const SdKind one : kind) worst = std::max(worst, one);
  return worst;
}

ChosenSd choose_sd(const RowStatistics& rows, const LinearSolution& s) {
  const Eigen::Index p = s.x.size();
  const auto n = static_cast<double>(s.n_rows);
  ChosenSd out;
  out.variance = s.covariance.diagonal();
  out.degrees_of_freedom = Eigen::VectorXd::Constant(p, s.degrees_of_freedom);
  out.effective_rows = n;
  // A variance with nu degrees of freedom has a relative sd of sqrt(2 / nu).
  const double white_enough =
      1 + std::max(kLeastExcess, kExcessSds * std::sqrt(2 / s.degrees_of_freedom));
  double slowest = 1;
  for (Eigen::Index k = 0; k < p; ++k) {
    const double white = s.covariance_white(k, k);
    const double inflation = white > 0 ? std::max(1.0, out.variance(k) / white) : 1;
    out.effective_rows = std::min(out.effective_rows, n / inflation);
    const bool is_slow = inflation > white_enough && n / inflation < kFewEffective;
    if (is_slow) slowest = std::max(slowest, inflation);
    out.kind.push_back(inflation < white_enough ? SdKind::white
                       : is_slow                ? SdKind::block_bootstrap
                                                : SdKind::hac);
  }
  if (out.worst() != SdKind::block_bootstrap) return out;
  if (static_cast<Eigen::Index>(rows.cells().size()) < kLeastCells) {
    std::replace(out.kind.begin(), out.kind.end(), SdKind::block_bootstrap, SdKind::hac);
    return out;
  }
  const Eigen::MatrixXd series = influences(rows, s);
  const double cells_per_row = static_cast<double>(series.rows()) / n;
  const auto resampled = [&](double inflation) {
    const double block = std::ceil(kBlockLengths * inflation * cells_per_row);
    return block_bootstrap(
        series, std::min(static_cast<Eigen::Index>(block), series.rows() / kLeastBlocks));
  };
  // HAC's own idea of the correlation length may be too short: that of the first blocks counts too.
  BootstrapSd bootstrap = resampled(slowest);
  for (Eigen::Index k = 0; k < p; ++k)
    if (out.kind[static_cast<std::size_t>(k)] == SdKind::block_bootstrap)
      slowest = std::max(slowest, bootstrap.sd(k) * bootstrap.sd(k) / s.covariance_white(k, k));
  bootstrap = resampled(slowest);
  out.blocks = series.rows() / bootstrap.block;
  for (Eigen::Index k = 0; k < p; ++k) {
    if (out.kind[static_cast<std::size_t>(k)] != SdKind::block_bootstrap) continue;
    out.variance(k) = std::max(out.variance(k), bootstrap.sd(k) * bootstrap.sd(k));
    out.degrees_of_freedom(k) = std::min(s.degrees_of_freedom, bootstrap.degrees_of_freedom);
  }
  return out;
}

}  // namespace cablefit
