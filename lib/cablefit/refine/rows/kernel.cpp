#include "cablefit/refine/rows/kernel.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

/// Lags in s, -reach .. reach.
Eigen::ArrayXd lags(double sd, double period) {
  const auto reach =
      std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::ceil(4 * sd / period)));
  return period * Eigen::ArrayXd::LinSpaced(2 * reach + 1, -static_cast<double>(reach),
                                            static_cast<double>(reach));
}

Eigen::ArrayXd bell(const Eigen::ArrayXd& t, double sd) { return (-0.5 * (t / sd).square()).exp(); }

}  // namespace

Kernel gaussian(double sd, double period) {
  const Eigen::ArrayXd weights = bell(lags(sd, period), sd);
  return {weights / weights.sum()};
}

Kernel gaussian_slope(double sd, double period) {
  const Eigen::ArrayXd t = lags(sd, period);
  const Eigen::ArrayXd weights = t * bell(t, sd);  // odd: gives 0 of 1 and of t^2
  return {weights / (weights * t).sum()};
}

Kernel gaussian_curvature(double sd, double period) {
  const Eigen::ArrayXd t = lags(sd, period);
  const Eigen::ArrayXd around = bell(t, sd);
  // Of the family (t^2 - c) bell, the one that gives 0 of 1; even, so 0 of t.
  const double c = (t.square() * around).sum() / around.sum();
  const Eigen::ArrayXd weights = (t.square() - c) * around;
  return {2 * weights / (weights * t.square()).sum()};
}

Eigen::ArrayXd apply(const Kernel& kernel, const Eigen::Ref<const Eigen::ArrayXd>& x) {
  const Eigen::Index n = x.size(), reach = kernel.reach();
  if (n == 0) return {};
  Eigen::ArrayXd padded(n + 2 * reach);
  padded << Eigen::ArrayXd::Constant(reach, x(0)), x, Eigen::ArrayXd::Constant(reach, x(n - 1));
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(n);
  for (Eigen::Index j = 0; j < kernel.weights.size(); ++j)
    out += kernel.weights(j) * padded.segment(j, n);
  return out;
}

Eigen::MatrixXd apply_at(const Kernel& kernel, const Eigen::Ref<const Eigen::MatrixXd>& x,
                         const std::vector<Eigen::Index>& rows) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), x.cols());
  const Eigen::Index width = kernel.weights.size();
  for (Eigen::Index column = 0; column < x.cols(); ++column)
    for (std::size_t i = 0; i < rows.size(); ++i)
      out(static_cast<Eigen::Index>(i), column) =
          kernel.weights.matrix().dot(x.col(column).segment(rows[i] - kernel.reach(), width));
  return out;
}

}  // namespace cablefit
