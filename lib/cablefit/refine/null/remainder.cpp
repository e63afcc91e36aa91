#include "cablefit/refine/null/remainder.hpp"

#include "cablefit/refine/gap_levels.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kLags = 64;

bool is_known(const ResidualMemory& memory) { return memory.n_values > 0; }

ArModel colour_of(const ResidualMemory& memory) {
  if (!is_known(memory) || !(memory.covariance(0) > 0)) return {};
  return fit_ar(memory.covariance, memory.period, memory.n_values);
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
    guess[k].covariance *= all > kDisturbed * noise ? (all - noise) / all : 0;
  }
  return guess;
}

KindMemory corrected(KindMemory guess, const KindMemory& left, const KindMemory& drawn) {
  for (std::size_t k = 0; k < kRowKinds; ++k)
    if (is_known(guess[k]) && is_known(drawn[k]) && guess[k].covariance(0) > 0)
      guess[k].covariance += left[k].covariance - drawn[k].covariance;
  return guess;
}

CopyDisturbance as_disturbance(const KindMemory& remainder, bool moves) {
  const auto of = [&](RowKind kind) {
    return colour_of(remainder[static_cast<std::size_t>(kind)]);
  };
  return {{of(moves ? RowKind::motor : RowKind::blocked)}, {of(RowKind::link)}};
}

bool is_quiet(const CopyDisturbance& disturbance) {
  for (const auto* models : {&disturbance.motor, &disturbance.link})
    for (const ArModel& model : *models)
      if (model.sd > 0) return false;
  return true;
}

}  // namespace cablefit
