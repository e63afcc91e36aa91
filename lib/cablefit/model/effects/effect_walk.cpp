#include "cablefit/model/effects/effect_walk.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace cablefit {

bool acts_as_torque(const Effect& row) { return row.torque != nullptr || row.level != nullptr; }

bool counts_on_rigid(const Effect& row) {
  const std::span<const Effect> all = candidate_effects();
  return row.site == Site::link && std::none_of(all.begin(), all.end(), [&](const Effect& r) {
           return r.site == Site::motor && r.name == row.name;
         });
}

bool is_continuous(const Effect& row, std::size_t shape) { return !row.shape[shape].is_whole; }

EffectWalk::EffectWalk(const Effect& row, std::vector<double> shape)
    : row_(row), shape_(std::move(shape)), z_(row.n_states), level_(row.n_linear()) {
  assert(acts_as_torque(row));
}

void EffectWalk::step(const JointState& state, double direction, double h, double* link,
                      double* motor) {
  // Half of the step before, half after: what they remember stands where the motion is.
  if (row_.advance != nullptr) row_.advance(state, shape_.data(), h / 2, z_.data());
  if (row_.torque != nullptr) row_.torque(state, shape_.data(), z_.data(), link, motor);
  if (row_.level != nullptr) {
    const double sign = direction > 0 ? 1.0 : direction < 0 ? -1.0 : 0.0;
    std::fill(level_.begin(), level_.end(), 0.0);
    row_.level(state, sign, shape_.data(), z_.data(), level_.data());
    double* own = row_.site == Site::link ? link : motor;
    for (std::size_t p = 0; p < level_.size(); ++p) own[p] += direction * level_[p];
  }
  if (row_.advance != nullptr) row_.advance(state, shape_.data(), h / 2, z_.data());
}

}  // namespace cablefit
