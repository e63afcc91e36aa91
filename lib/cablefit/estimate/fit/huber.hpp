// Huber's M-estimate of a linear regression: outliers count less. What is needed of the rows, pass
// by pass, in constant memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace cablefit {

/// Tuning constant: 95 % efficiency on normal residuals (Huber 1981, 7.4).
inline constexpr double kHuberC = 1.345;

/// Median of |x| in one pass: bins of `largest_guess` / 4000, two nearest interpolated. Values
/// beyond the guess count as larger than all others.
class AbsoluteMedian {
 public:
  explicit AbsoluteMedian(double largest_guess);
  void add(double x);
  /// 0 without values.
  double result() const;
  /// sd of normal values with this median of |x|: result() / 0.6745.
  double normal_sd() const { return result() / 0.67448975019608171; }

 private:
  double width_;
  std::vector<std::size_t> counts_;
  std::size_t n_ = 0;
};

/// Residuals pulled in to +- kHuberC scale: psi(r) = r for |r| <= c s, else c s sgn(r).
struct Huber {
  double scale = 0;
  double psi(double r) const;
  /// psi(r)/r: 1 for an inlier, towards 0 for an outlier.
  double weight(double r) const;
  bool is_inlier(double r) const;
};

/// Beyond so many scales a residual is suspect: of n normal ones less than one in twenty logs
/// has any (2 Q(z) <= exp(-z^2/2), Chernoff's bound), and never less than 4.5.
double suspect_limit(std::size_t n);

/// Ordinary least squares on rows whose response is made of pulled-in residuals, x b + psi(r)/m
/// with m the share of inliers, has the M-estimate as its solution and the M-estimate's covariance,
/// sum psi^2 / m^2, as its own (Huber 1981, 7.6 and 7.8, pseudo-observations). Changes the column
/// `response` of the rows by psi(r)/m - r. `combination`: rows * combination = r.
void pull_in(const Huber& huber, double inlier_share, const Eigen::VectorXd& combination,
             Eigen::Index response, Eigen::MatrixXd& rows);

}  // namespace cablefit
