// Gradient estimator: the normalised least mean squares rule (NLMS; Nagumo & Noda 1967; Haykin
// 2002, ch. 6; Ljung & Soderstrom 1983, 3.6) on columns scaled to one rms.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// x += step * D^2 w e / (w'D^2 w) with the a-priori error e = y - w'x and D = diag(1/rms of a
/// column). A row's own error becomes (1 - step) e, so that the rule is stable for 0 < step < 2,
/// whatever the rows: in steps of D^2 w e the bound is 2/(w'D^2 w), 2/trace of the scaled rows'
/// second moments. The mean error along an eigenvector of their correlation matrix with eigenvalue
/// lambda falls with a time constant of p/(step lambda) rows.
class NormalisedGradient {
 public:
  /// `rms`: of every column; 0: the parameter stays 0. `step`: 0 < step < 2 for stability.
  NormalisedGradient(const Eigen::VectorXd& rms, double step);

  /// One row, y = w x + noise.
  void add(const Eigen::Ref<const Eigen::RowVectorXd>& w, double y);
  const Eigen::VectorXd& x() const { return x_; }

  /// sd of x in the steady state for white noise of this sd and a small step:
  /// noise sqrt(step/((2 - step) p)) / rms; 0 for a parameter that stays 0.
  Eigen::VectorXd steady_sd(double noise_sd) const;

 private:
  Eigen::VectorXd inverse_rms_;  ///< 0: not estimated
  double step_;
  Eigen::VectorXd x_;
};

/// The step with which a direction of average power has a time constant of so many rows:
/// p / rows, at most 1, where a row's own error vanishes. `p`: parameters that are estimated.
double gradient_step(Eigen::Index p, double rows);

/// Time constants in rows of the slowest direction over that of average power: 1/least eigenvalue
/// of the correlation matrix of the columns. `r`: n x p, a factor of their second moments (R of a
/// QR, or the rows); columns of zeros are left out.
double slowest_direction(const Eigen::MatrixXd& r);

}  // namespace cablefit
