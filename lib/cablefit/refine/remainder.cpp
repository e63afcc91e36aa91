#include "cablefit/refine/remainder.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kLags = 64;
constexpr double kVisible = 1.05;  // squared residual over floor; floors are known to some per cent

bool is_known(const ResidualMemory& memory) { return memory.n_values > 0; }

ArModel colour_of(const ResidualMemory& memory) {
  if (!is_known(memory) || !(memory.covariance(0) > 0)) return {};
  return fit_ar(memory.covariance, memory.period, memory.n_values);
}

/// Of the lags, both ways, up to where they change their sign: white noise with as much in the
/// band that a kernel lets pass.
double sum_of_kernel(const Eigen::VectorXd& covariance) {
  double sum = covariance(0);
  for (Eigen::Index lag = 1; lag < covariance.size() && covariance(lag) > 0; ++lag)
    sum += 2 * covariance(lag);
  return sum;
}

}  // namespace

KindMemory memory_of(const Design& design, const Eigen::VectorXd& x) {
  KindMemory memory;
  for (std::size_t k = 0; k < kRowKinds; ++k)
    memory[k] = residual_memory(design, x, static_cast<RowKind>(k), kLags);
  return memory;
}

KindMemory mean_of(const std::vector<KindMemory>& several) {
  KindMemory mean = several.front();
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    if (!is_known(mean[k])) continue;
    mean[k].covariance.setZero();
    for (const KindMemory& one : several)
      mean[k].covariance += one[k].covariance / static_cast<double>(several.size());
  }
  return mean;
}

KindMemory remainder_of(const KindMemory& left, const KindLevels& floor) {
  KindMemory guess = left;
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    if (!is_known(left[k])) continue;
    const double all = left[k].covariance(0), noise = floor[k] * floor[k];
    guess[k].covariance *= all > kVisible * noise ? (all - noise) / all : 0;
  }
  return guess;
}

KindMemory corrected(KindMemory guess, const KindMemory& left, const KindMemory& drawn) {
  for (std::size_t k = 0; k < kRowKinds; ++k)
    if (is_known(guess[k]) && is_known(drawn[k]) && guess[k].covariance(0) > 0)
      guess[k].covariance += left[k].covariance - drawn[k].covariance;
  return guess;
}

RowWhitening whitening_of(const KindMemory& left, const KindMemory& noise, double block_seconds) {
  std::array<Eigen::VectorXd, kRowKinds> wandering;
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    if (!is_known(left[k]) || !is_known(noise[k])) continue;
    const Eigen::VectorXd &all = left[k].covariance, &sensors = noise[k].covariance;
    if (all(0) <= kVisible * sensors(0)) continue;
    // Bartlett's window: the rows are too few to know the long lags.
    const Eigen::VectorXd window =
        1 - Eigen::ArrayXd::LinSpaced(all.size(), 0, 1 - 1 / static_cast<double>(all.size()));
    wandering[k] = window.cwiseProduct(all - sensors);
    wandering[k](0) += sum_of_kernel(sensors);
  }
  return {wandering, block_seconds};
}

TwinDisturbance as_disturbance(const KindMemory& remainder, bool moves) {
  const auto of = [&](RowKind kind) {
    return colour_of(remainder[static_cast<std::size_t>(kind)]);
  };
  return {{of(moves ? RowKind::motor : RowKind::blocked)}, {of(RowKind::link)}};
}

bool is_quiet(const TwinDisturbance& disturbance) {
  for (const auto* models : {&disturbance.motor, &disturbance.link})
    for (const ArModel& model : *models)
      if (model.sd > 0) return false;
  return true;
}

}  // namespace cablefit
