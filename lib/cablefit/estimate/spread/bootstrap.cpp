#include "cablefit/estimate/spread/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace cablefit {

BootstrapSd block_bootstrap(const Eigen::Ref<const Eigen::MatrixXd>& series, Eigen::Index block,
                            int n_replicates, std::uint64_t seed) {
  const Eigen::Index n = series.rows(), p = series.cols();
  BootstrapSd out;
  out.block = std::clamp<Eigen::Index>(block, 1, std::max<Eigen::Index>(1, n / 2));
  const Eigen::Index n_starts = n - out.block + 1;
  Eigen::MatrixXd sums(n_starts, p);  // of the block that begins there
  sums.row(0) = series.topRows(out.block).colwise().sum();
  for (Eigen::Index i = 1; i < n_starts; ++i)
    sums.row(i) = sums.row(i - 1) + series.row(i + out.block - 1) - series.row(i - 1);
  sums.rowwise() -= sums.colwise().mean().eval();
  const Eigen::Index n_blocks = std::max<Eigen::Index>(1, n / out.block);
  const double whole = static_cast<double>(n) / static_cast<double>(n_blocks * out.block);
  std::mt19937_64 engine(seed);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(p);
  for (int replicate = 0; replicate < n_replicates; ++replicate) {
    Eigen::RowVectorXd total = Eigen::RowVectorXd::Zero(p);
    for (Eigen::Index k = 0; k < n_blocks; ++k)  // a modulus of 2^64: its bias is 1e-15
      total += sums.row(static_cast<Eigen::Index>(engine() % static_cast<std::uint64_t>(n_starts)));
    squares += total.cwiseAbs2().transpose();
  }
  const double about_mean = static_cast<double>(n) / static_cast<double>(n - out.block);
  out.sd = (whole * about_mean / n_replicates * squares).cwiseSqrt();
  out.degrees_of_freedom =
      std::max(1.0, 1.5 * static_cast<double>(n) / static_cast<double>(out.block) - 1);
  return out;
}

}  // namespace cablefit
