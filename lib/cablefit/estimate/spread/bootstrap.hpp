// The block bootstrap of Kunsch 1989 for sums of a slowly correlated series: few long blocks, and
// Student's t of as many degrees of freedom as they leave.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace cablefit {

struct BootstrapSd {
  Eigen::VectorXd sd;             ///< of the sum of every column
  double degrees_of_freedom = 0;  ///< for t quantiles
  Eigen::Index block = 0;         ///< entries in a block
};

/// Resamples overlapping blocks of `block` entries with replacement (n / block of them at a time)
/// and takes the sd of the sums. `series`: n x p, mean about zero. Blocks see less than the whole
/// variance, since they are taken about the mean of all: it is scaled by n / (n - block). The
/// degrees of freedom are those of as many overlapping blocks, 1.5 n / block - 1 (Bartlett's
/// kernel). Deterministic.
BootstrapSd block_bootstrap(const Eigen::Ref<const Eigen::MatrixXd>& series, Eigen::Index block,
                            int n_replicates = 999, std::uint64_t seed = 1);

}  // namespace cablefit
