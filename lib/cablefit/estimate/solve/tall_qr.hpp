// R of a tall, narrow matrix at the price of its Gram matrix, with the accuracy of a QR.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// R of rows = Q R, upper triangular, its signs free. Preconditioned Cholesky QR: R0 from the
/// Householder QR of every 16th row makes rows R0^-1 nearly orthogonal, so that forming its Gram
/// matrix loses nothing, and R = chol(Gram) R0 (Fukaya et al. 2020, "LU-Cholesky QR", with rows
/// sampled for the preconditioner). Where the sample does not stand for the rows, or the rows are
/// few, plain Householder QR (Golub & Van Loan 2013, ch. 5).
Eigen::MatrixXd tall_qr(const Eigen::Ref<const Eigen::MatrixXd>& rows);

}  // namespace cablefit
