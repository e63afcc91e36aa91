#include "cablefit/estimate/fit/gradient.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace cablefit {

NormalisedGradient::NormalisedGradient(const Eigen::VectorXd& rms, double step)
    : inverse_rms_(rms), step_(step), x_(Eigen::VectorXd::Zero(rms.size())) {
  for (double& value : inverse_rms_) value = value > 0 ? 1 / value : 0;
}

void NormalisedGradient::add(const Eigen::Ref<const Eigen::RowVectorXd>& w, double y) {
  const Eigen::VectorXd scaled = w.transpose().cwiseProduct(inverse_rms_);
  const double power = scaled.squaredNorm();
  if (!(power > 0)) return;
  x_ += step_ * (y - w.dot(x_)) / power * scaled.cwiseProduct(inverse_rms_);
}

Eigen::VectorXd NormalisedGradient::steady_sd(double noise_sd) const {
  const double p =
      static_cast<double>(std::max<Eigen::Index>(1, (inverse_rms_.array() > 0).count()));
  return noise_sd * std::sqrt(step_ / ((2 - step_) * p)) * inverse_rms_;
}

double gradient_step(Eigen::Index p, double rows) {
  return std::min(1.0, static_cast<double>(p) / rows);
}

double slowest_direction(const Eigen::MatrixXd& r) {
  std::vector<Eigen::Index> used;
  for (Eigen::Index k = 0; k < r.cols(); ++k)
    if (r.col(k).norm() > 0) used.push_back(k);
  if (used.empty()) return 1;
  Eigen::MatrixXd scaled = r(Eigen::all, used);
  scaled.colwise().normalize();
  const double least = Eigen::JacobiSVD<Eigen::MatrixXd>(scaled).singularValues().minCoeff();
  return least > 0 ? 1 / (least * least) : std::numeric_limits<double>::infinity();
}

}  // namespace cablefit
