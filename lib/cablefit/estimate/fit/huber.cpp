#include "cablefit/estimate/fit/huber.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr std::size_t kBins = 4000;
constexpr double kLeastLimit = 4.5;
constexpr double kFalseAlarms = 0.05;  // a log

}  // namespace

AbsoluteMedian::AbsoluteMedian(double largest_guess)
    : width_(largest_guess / static_cast<double>(kBins)), counts_(kBins + 1, 0) {}

void AbsoluteMedian::add(double x) {
  const double place = width_ > 0 ? std::abs(x) / width_ : 0;
  counts_[place < static_cast<double>(kBins) ? static_cast<std::size_t>(place) : kBins] += 1;
  ++n_;
}

double AbsoluteMedian::result() const {
  if (n_ == 0) return 0;
  const double half = 0.5 * static_cast<double>(n_);
  double below = 0;
  std::size_t bin = 0;
  while (bin < kBins && below + static_cast<double>(counts_[bin]) < half)
    below += static_cast<double>(counts_[bin++]);
  const double in_bin = static_cast<double>(std::max<std::size_t>(1, counts_[bin]));
  return width_ * (static_cast<double>(bin) + std::min(1.0, (half - below) / in_bin));
}

double Huber::psi(double r) const { return std::clamp(r, -kHuberC * scale, kHuberC * scale); }

double Huber::weight(double r) const { return is_inlier(r) ? 1 : psi(r) / r; }

bool Huber::is_inlier(double r) const { return std::abs(r) <= kHuberC * scale; }

double suspect_limit(std::size_t n) {
  return std::max(kLeastLimit, std::sqrt(2 * std::log(static_cast<double>(n) / kFalseAlarms)));
}

void pull_in(const Huber& huber, double inlier_share, const Eigen::VectorXd& combination,
             Eigen::Index response, Eigen::MatrixXd& rows) {
  const Eigen::VectorXd residual = rows * combination;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    rows(i, response) += huber.psi(residual(i)) / inlier_share - residual(i);
}

}  // namespace cablefit
