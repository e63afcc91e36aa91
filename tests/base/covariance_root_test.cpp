#include "cablefit/base/covariance_root.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

using cablefit::covariance_root;

/// Largest difference between two covariances, in units of the first one's sd.
double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::VectorXd over = a.diagonal().cwiseSqrt().cwiseInverse();
  return (over.asDiagonal() * (a - b) * over.asDiagonal()).cwiseAbs().maxCoeff();
}

TEST_CASE("a root of a covariance does not depend on units") {
  // Correlations 0.5, 0.99, 0.5 between a torque, a stiffness and a cubic coefficient.
  Eigen::Matrix3d correlation;
  correlation << 1, 0.5, 0.99, 0.5, 1, 0.5, 0.99, 0.5, 1;
  const Eigen::Vector3d sd(2e-3, 50, 3e9);
  const Eigen::MatrixXd a = sd.asDiagonal() * correlation * sd.asDiagonal();
  const Eigen::MatrixXd r = covariance_root(a);
  // Products and eigenvalues of a 3 x 3 matrix: a few roundings, each of 1.1e-16.
  CHECK(difference(a, r * r.transpose()) < 1e-14);
}

TEST_CASE("a root of a singular covariance has a column of zeros per zero eigenvalue") {
  Eigen::MatrixXd factors(4, 2);
  factors << 1.0 / 3, 0.2, -0.7, 0.1, 0.9, -1.0 / 7, 0.3, 0.6;
  const Eigen::MatrixXd a = factors * factors.transpose();  // two eigenvalues are 3e-17 and 3e-16
  const Eigen::MatrixXd r = covariance_root(a);
  CHECK((r.colwise().norm().array() > 0).count() == 2);
  CHECK((r * r.transpose() - a).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("a root of a covariance leaves out what does not vary") {
  const Eigen::MatrixXd a = Eigen::Vector3d(4, 0, 9).asDiagonal();
  const Eigen::MatrixXd r = covariance_root(a);
  CHECK((r.colwise().norm().array() > 0).count() == 2);
  CHECK((r * r.transpose() - a).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(covariance_root(Eigen::MatrixXd(0, 0)).size() == 0);
}

}  // namespace
