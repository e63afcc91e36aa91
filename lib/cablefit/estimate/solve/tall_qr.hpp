// R of a tall, narrow matrix at the price of its Gram matrix, with the accuracy of a QR.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cablefit {

struct TallQr {
  Eigen::MatrixXd r;                   ///< n x n, upper triangular, its signs free
  std::vector<Eigen::MatrixXd> grams;  ///< of each stretch, n x n, symmetric, full
};

/// R of rows = Q R, and the Gram matrices of stretches of the rows: stretch k is rows
/// [ends[k - 1], ends[k]), the last one ends with the rows; no ends, no Gram matrices.
/// Preconditioned Cholesky QR: R0 from the Householder QR of every 16th row or oftener makes rows
/// R0^-1 nearly orthogonal, so that forming its Gram matrix G loses nothing, and R = chol(G) R0
/// (Fukaya et al. 2020, "LU-Cholesky QR", with rows sampled for the preconditioner); of a stretch,
/// rows' rows = R0' G R0. Where the sample does not stand for the rows, or the rows are few, plain
/// Householder QR (Golub & Van Loan 2013, ch. 5).
TallQr tall_qr(const Eigen::Ref<const Eigen::MatrixXd>& rows,
               std::span<const Eigen::Index> ends = {});

}  // namespace cablefit
