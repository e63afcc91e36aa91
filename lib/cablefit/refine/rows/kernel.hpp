// Smoothing kernels of refine's rows: every column has the same kernel, and derivatives act on the
// kernel (weak form; Messenger & Bortz 2021). Internal to refine/.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cablefit {

/// Symmetric weights at lags -reach .. reach.
struct Kernel {
  Eigen::ArrayXd weights;
  Eigen::Index reach() const { return weights.size() / 2; }
};

/// Gaussian of standard deviation `sd` (s) sampled every `period` (s) over +-4 sd, and its first
/// two derivatives (per s, per s^2). The truncated samples are corrected so that the results for 1,
/// t and t^2 are exact. An uncorrected second derivative gives an acceleration for a constant
/// position.
Kernel gaussian(double sd, double period);
Kernel gaussian_slope(double sd, double period);
Kernel gaussian_curvature(double sd, double period);

/// sum_j weights[j] x[i + j] for every i; beyond the ends the first and last value are repeated.
Eigen::ArrayXd apply(const Kernel& kernel, const Eigen::Ref<const Eigen::ArrayXd>& x);

/// As above, for every column and only at `rows`, all at least `reach` from the ends.
Eigen::MatrixXd apply_at(const Kernel& kernel, const Eigen::Ref<const Eigen::MatrixXd>& x,
                         const std::vector<Eigen::Index>& rows);

}  // namespace cablefit
