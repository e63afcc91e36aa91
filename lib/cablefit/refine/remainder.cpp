#include "cablefit/refine/remainder.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/refine/residual_spectrum.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kLags = 64;
constexpr double kVisible = 1.05;  // squared residual over floor; floors are known to some per cent

/// Residuals of one kind on the grid of its rows, as an autoregressive torque.
ArModel colour_of(const Design& design, const Eigen::VectorXd& x, RowKind wanted, double floor) {
  const ResidualMemory memory = residual_memory(design, x, wanted, kLags);
  if (memory.n_values == 0) return {};
  Eigen::VectorXd covariance = memory.covariance;
  const double excess = covariance(0) - floor * floor;
  if (!(covariance(0) > kVisible * floor * floor)) return {};
  covariance *= excess / covariance(0);
  return fit_ar(covariance, memory.period, memory.n_values);
}

}  // namespace

TwinDisturbance remainder_of(const Design& design, const Eigen::VectorXd& x,
                             const KindLevels& floor) {
  const auto of = [&](RowKind kind) {
    return colour_of(design, x, kind, floor[static_cast<std::size_t>(kind)]);
  };
  // Blocked logs alone have no rows of the motor in motion.
  const bool moves = std::any_of(design.stretches.begin(), design.stretches.end(),
                                 [](const Stretch& stretch) { return !stretch.blocked; });
  return {{of(moves ? RowKind::motor : RowKind::blocked)}, {of(RowKind::link)}};
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
