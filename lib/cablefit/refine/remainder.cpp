#include "cablefit/refine/remainder.hpp"

#include <cmath>

namespace cablefit {
namespace {

constexpr std::size_t kLags = 64;
constexpr double kVisible = 1.05;  // squared residual over floor; floors are known to some per cent

/// Residuals of one kind on the grid of its rows, as an autoregressive torque.
ArModel colour_of(const Design& design, const Eigen::VectorXd& x, RowKind wanted, double floor) {
  Autocovariance sums(kLags);
  Eigen::Index offset = 0;
  double period = 0;
  for (std::size_t s = 0; s < design.rows.size(); ++s) {
    for (const KindRows& kind : design.rows[s].kinds) {
      if (kind.kind != wanted) continue;
      std::vector<Eigen::Index> numbers;
      for (const Eigen::Index at : kind.at)
        numbers.push_back(offset + at / design.smoothing.stride);
      sums.add(numbers, kind.response - kind.base * x);
    }
    const Recording& r = design.stretches[s].recording;
    period = static_cast<double>(design.smoothing.stride) * r.period;
    offset += r.theta.size() / design.smoothing.stride + static_cast<Eigen::Index>(kLags) + 1;
  }
  if (sums.n_values() == 0) return {};
  Eigen::VectorXd covariance = sums.values();
  const double excess = covariance(0) - floor * floor;
  if (!(covariance(0) > kVisible * floor * floor)) return {};
  covariance *= excess / covariance(0);
  return fit_ar(covariance, period, sums.n_values());
}

}  // namespace

TwinDisturbance remainder_of(const Design& design, const Eigen::VectorXd& x,
                             const KindLevels& floor) {
  const auto of = [&](RowKind kind) {
    return colour_of(design, x, kind, floor[static_cast<std::size_t>(kind)]);
  };
  return {{of(RowKind::motor)}, {of(RowKind::link)}};
}

TwinDisturbance scaled(TwinDisturbance disturbance, const KindLevels& factors) {
  const auto scale = [&](std::vector<ArModel>& models, RowKind kind) {
    for (ArModel& model : models) {
      model.sd *= factors[static_cast<std::size_t>(kind)];
      model.innovation_sd *= factors[static_cast<std::size_t>(kind)];
    }
  };
  scale(disturbance.motor, RowKind::motor);
  scale(disturbance.link, RowKind::link);
  return disturbance;
}

bool is_quiet(const TwinDisturbance& disturbance) {
  for (const auto* models : {&disturbance.motor, &disturbance.link})
    for (const ArModel& model : *models)
      if (model.sd > 0) return false;
  return true;
}

}  // namespace cablefit
