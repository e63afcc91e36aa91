// The hot loops of streamed least squares: products of tall, narrow matrices.
#pragma once

#include <Eigen/Core>

namespace cablefit {

/// gram += rows' rows, upper triangle only. The order of summation is fixed (four lanes over rows,
/// whatever the machine's registers), so that the bits are the same everywhere.
void add_gram(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::MatrixXd& gram);

/// rows = rows r^-1 for an upper triangular r whose diagonal has no zero.
void divide_by_triangle(Eigen::MatrixXd& rows, const Eigen::MatrixXd& r);

}  // namespace cablefit
