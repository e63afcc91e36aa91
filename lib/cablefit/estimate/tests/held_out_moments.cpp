#include "cablefit/estimate/tests/held_out_moments.hpp"

#include <Eigen/QR>

namespace cablefit {
namespace {

/// Gram matrix of [regressors, response, instruments] of columns of unit size.
struct MomentGram {
  Eigen::MatrixXd gram;
  Eigen::Index n_regressors = 0, n_instruments = 0;

  auto regressors() const { return Eigen::seqN(Eigen::Index{0}, n_regressors); }
  auto instruments() const { return Eigen::seqN(n_regressors + 1, n_instruments); }
  Eigen::VectorXd plain() const {
    const Eigen::MatrixXd w = gram(regressors(), regressors());
    return w.completeOrthogonalDecomposition().solve(gram(regressors(), n_regressors));
  }
  Eigen::VectorXd with() const {
    const Eigen::MatrixXd zz = gram(instruments(), instruments());
    const Eigen::MatrixXd zw = gram(instruments(), regressors());
    const Eigen::MatrixXd seen = zz.completeOrthogonalDecomposition().solve(zw);
    return (zw.transpose() * seen)
        .eval()
        .completeOrthogonalDecomposition()
        .solve(seen.transpose() * gram(instruments(), n_regressors));
  }
  double moment(const Eigen::VectorXd& x) const {
    const Eigen::VectorXd z =
        gram(instruments(), n_regressors) - gram(instruments(), regressors()) * x;
    const Eigen::MatrixXd zz = gram(instruments(), instruments());
    return z.dot(zz.completeOrthogonalDecomposition().solve(z));
  }
};

}  // namespace

HeldOutMoments held_out_moments(const RowStatistics& rows, const LinearProblem& problem,
                                int n_blocks) {
  HeldOutMoments out;
  const auto& cells = rows.cells();
  if (cells.size() < static_cast<std::size_t>(n_blocks) || problem.instruments.empty()) return out;
  std::vector<Eigen::Index> regressors;
  for (std::size_t k = 0; k < problem.regressors.size(); ++k)
    if (k >= problem.held.size() || problem.held[k].empty())
      regressors.push_back(problem.regressors[k]);
  const auto p = static_cast<Eigen::Index>(regressors.size());
  const auto m = static_cast<Eigen::Index>(problem.instruments.size());
  Eigen::MatrixXd choose = Eigen::MatrixXd::Zero(rows.n_columns(), p + 1 + m);
  for (Eigen::Index k = 0; k < p; ++k) choose(regressors[static_cast<std::size_t>(k)], k) = 1;
  choose.col(p) = problem.response;
  for (Eigen::Index k = 0; k < m; ++k)
    choose(problem.instruments[static_cast<std::size_t>(k)], p + 1 + k) = 1;
  Eigen::VectorXd size = (rows.r() * choose).colwise().norm();
  for (double& s : size) s = s > 0 ? 1 / s : 0;
  choose = choose * size.asDiagonal();
  std::vector<Eigen::MatrixXd> blocks(static_cast<std::size_t>(n_blocks),
                                      Eigen::MatrixXd::Zero(p + 1 + m, p + 1 + m));
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(p + 1 + m, p + 1 + m);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Eigen::MatrixXd gram = choose.transpose() * cells[c].gram * choose;
    blocks[c * blocks.size() / cells.size()] += gram;
    all += gram;
  }
  for (const Eigen::MatrixXd& block : blocks) {
    const MomentGram others{all - block, p, m}, held_out{block, p, m};
    out.plain += held_out.moment(others.plain());
    out.with += held_out.moment(others.with());
  }
  return out;
}

}  // namespace cablefit
