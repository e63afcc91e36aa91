#include "cablefit/dynamic/output_error/instrumental_fit.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/estimate/fit/instruments.hpp"
#include "cablefit/estimate/spread/long_run.hpp"

namespace cablefit {
namespace {

constexpr int kMostSteps = 8;
constexpr double kSmallestStepSd = 0.05;  // sd

/// One linear problem: J, r and Z of the parameters that move, compressed, prior included.
struct Step {
  std::vector<Eigen::Index> free;
  Eigen::MatrixXd j, z;
  Eigen::VectorXd r;
  Eigen::MatrixXd influence;  ///< A = (Z'J)^-1: x moves by -A Z'r
  double variance = 1;        ///< of r
};

Step step_of(const InstrumentedSums& sums, const std::vector<Eigen::Index>& free, Eigen::Index p) {
  StreamingQr all(2 * p + 1);
  all.add(sums.rows.r());
  if (sums.prior.rows() > 0) {
    Eigen::MatrixXd prior(sums.prior.rows(), 2 * p + 1);
    prior << sums.prior, sums.prior.leftCols(p);
    all.add(prior);
  }
  std::vector<Eigen::Index> instruments = free;
  for (Eigen::Index& k : instruments) k += p + 1;
  Step step{free, all.r()(Eigen::all, free), all.r()(Eigen::all, instruments), all.r().col(p), {},
            1};
  // Z = Q R: (Z'J)^-1 = (Q'J)^-1 R'^-1, without the square of Z's condition.
  const auto n = static_cast<Eigen::Index>(free.size());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(step.z);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(step.z.rows(), n);
  const Eigen::MatrixXd inner = q.transpose() * step.j;
  const Eigen::MatrixXd upper = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd lower_inverse =
      upper.transpose().triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(n, n));
  step.influence = inner.partialPivLu().solve(lower_inverse);
  const auto n_rows = static_cast<double>(sums.rows.n_rows());
  step.variance = sums.rows.r().col(p).squaredNorm() / std::max(1.0, n_rows - double(n));
  return step;
}

/// Instruments hardly move as some parameter's own column does.
bool is_weak(const Step& step, double effective_rows) {
  const auto n = static_cast<Eigen::Index>(step.free.size());
  const Eigen::MatrixXd with =
      step.influence * (step.z.transpose() * step.z) * step.influence.transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(step.j);
  const Eigen::MatrixXd upper = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd root =
      upper.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
  for (Eigen::Index k = 0; k < n; ++k) {
    const double share = std::min(1.0, root.row(k).squaredNorm() / with(k, k));
    if (!(first_stage_f(share, effective_rows) >= kStrongFirstStage)) return true;
  }
  return false;
}

/// Robust and white, as in fit_estimates.cpp.
void fill_covariance(const Step& step, const InstrumentedSums& sums, Eigen::Index p,
                     InstrumentalFit& fit) {
  const auto n = static_cast<Eigen::Index>(step.free.size());
  Eigen::MatrixXd of_prior = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd prior_rows = Eigen::MatrixXd::Zero(n, n);
  if (sums.prior.rows() > 0) {
    const Eigen::MatrixXd own = sums.prior(Eigen::all, step.free);
    prior_rows = own.transpose() * own;
    of_prior = step.influence * prior_rows * step.influence.transpose();
  }
  const Eigen::MatrixXd white = step.variance * step.influence *
                                    (step.z.transpose() * step.z - prior_rows) *
                                    step.influence.transpose() +
                                of_prior;
  Eigen::MatrixXd robust = white;
  fit.effective_rows = static_cast<double>(sums.rows.n_rows());
  fit.degrees_of_freedom = std::max(1.0, fit.effective_rows - static_cast<double>(n));
  const auto n_cells = static_cast<Eigen::Index>(sums.rows.cells().size());
  if (n_cells >= 8) {
    const Eigen::MatrixXd series =
        series_over_time(sums.rows.cells(), n, [&](const GramCell& cell) -> Eigen::RowVectorXd {
          const Eigen::VectorXd scores = cell.gram.col(p).tail(p);
          return (step.influence * scores(step.free)).transpose();
        });
    const LongRunCovariance hac = interval_covariance(series);
    robust = hac.covariance + of_prior;
    fit.degrees_of_freedom = hac.degrees_of_freedom;
    double ratio = 0;
    for (Eigen::Index k = 0; k < n; ++k) {  // no credit for anti-correlated residuals
      if (robust(k, k) < white(k, k)) {
        const double grow = robust(k, k) > 0 ? std::sqrt(white(k, k) / robust(k, k)) : 0;
        robust.row(k) *= grow;
        robust.col(k) *= grow;
        robust(k, k) = white(k, k);
      }
      ratio += robust(k, k) / white(k, k) / static_cast<double>(n);
    }
    fit.effective_rows /= ratio;
  }
  fit.covariance = fit.covariance_white = Eigen::MatrixXd::Zero(p, p);
  fit.covariance(step.free, step.free) = robust;
  fit.covariance_white(step.free, step.free) = white;
}

}  // namespace

InstrumentalFit solve_instrumental(
    const Eigen::VectorXd& start, const std::vector<bool>& moves,
    const std::function<InstrumentedSums(const Eigen::VectorXd&)>& sums) {
  InstrumentalFit fit;
  fit.x = start;
  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < moves.size(); ++k)
    if (moves[k]) free.push_back(static_cast<Eigen::Index>(k));
  fit.failure = "it did not converge";
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostSteps && !free.empty(); ++i) {
    const InstrumentedSums at = sums(fit.x);
    ++fit.n_passes;
    if (at.rows.n_rows() <= start.size()) {
      fit.failure = "the simulation diverges";
      return fit;
    }
    const Step step = step_of(at, free, start.size());
    const Eigen::VectorXd change = -step.influence * (step.z.transpose() * step.r);
    fill_covariance(step, at, start.size(), fit);
    if (!change.allFinite() || is_weak(step, fit.effective_rows)) {
      fit.failure = "the simulated loop does not reproduce the measured motion";
      return fit;
    }
    fit.x(free) += change;
    double longest = 0;
    for (std::size_t k = 0; k < free.size(); ++k)
      longest = std::max(longest, std::abs(change(static_cast<Eigen::Index>(k))) /
                                      std::sqrt(fit.covariance(free[k], free[k])));
    if (longest <= kSmallestStepSd) {
      fit.failure.clear();
      return fit;
    }
    if (longest > before) return fit;  // Newton's steps that grow lead nowhere, and each costs
    before = longest;
  }
  return fit;
}

}  // namespace cablefit
