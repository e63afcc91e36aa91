#include "cablefit/estimate/solve/null_space.hpp"

#include <Eigen/QR>

namespace cablefit {
namespace {

constexpr double kRank = 1e-12;  // of a row against the others: below, it says what they say

}  // namespace

Eigen::MatrixXd null_space(const Eigen::MatrixXd& rows) {
  const Eigen::Index n = rows.cols();
  if (rows.rows() == 0) return Eigen::MatrixXd::Identity(n, n);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows.transpose());
  qr.setThreshold(kRank);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
  return q.rightCols(n - qr.rank());
}

}  // namespace cablefit
