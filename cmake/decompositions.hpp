// Eigen's decompositions of MatrixXd, compiled once in decompositions.cpp: a file that only uses
// one is built in two thirds of the time. The precompiled headers include this header. A file that
// uses a decomposition includes the header of Eigen.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#define CABLEFIT_DECOMPOSITIONS(prefix)                                                            \
  prefix template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;                               \
  prefix template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;                   \
  prefix template class Eigen::HouseholderQR<Eigen::MatrixXd>;                                     \
  prefix template class Eigen::JacobiSVD<Eigen::MatrixXd>;                                         \
  prefix template class Eigen::LDLT<Eigen::MatrixXd>;                                              \
  prefix template class Eigen::LLT<Eigen::MatrixXd>;                                               \
  prefix template class Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;                            \
  prefix template Eigen::LDLT<Eigen::MatrixXd>&                                                    \
  Eigen::LDLT<Eigen::MatrixXd>::compute<Eigen::MatrixXd>(                                          \
      const Eigen::EigenBase<Eigen::MatrixXd>&);                                                   \
  prefix template Eigen::LLT<Eigen::MatrixXd>&                                                     \
  Eigen::LLT<Eigen::MatrixXd>::compute<Eigen::MatrixXd>(const Eigen::EigenBase<Eigen::MatrixXd>&); \
  prefix template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>&                                  \
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute<Eigen::MatrixXd>(                        \
      const Eigen::EigenBase<Eigen::MatrixXd>&, int)

CABLEFIT_DECOMPOSITIONS(extern);
