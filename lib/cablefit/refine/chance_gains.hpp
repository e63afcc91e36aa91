// What searches of simulated data sets without an effect gain, which a search of the logs has to
// beat. Internal to refine/.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "cablefit/refine/chance_tail.hpp"
#include "cablefit/refine/null_draws.hpp"

namespace cablefit {

class ChanceGains {
 public:
  explicit ChanceGains(const std::vector<NullDraw>& draws);

  std::size_t n_draws() const { return always_.size(); }

  /// How likely the largest gain of a search of nothing is this large. Of what is always there two
  /// ways, and twice the smaller (Bonferroni; not where no draws could tell less): as it is, and
  /// counted in what its own row gains by chance, as rows that act where one equation wanders gain
  /// much and the others do not (studentized maximum; Westfall & Young 1993). Events compete with
  /// events.
  ChanceTail tail(const Refinement& row, double gain) const;

  /// Whether it is more than `times` the largest of all draws, in one of these ways.
  bool is_beyond(const Refinement& row, double gain, double times) const;

  /// What is gained by chance, about: by the row itself, by the luckiest event that lasts, or that
  /// passes. 0 without draws.
  double usual(const Refinement& row) const;

 private:
  /// rms of the gains of a row in all draws but `but`.
  double rms_without(const Refinement& row, std::size_t but) const;
  double unit(const Refinement& row, std::size_t but) const;

  std::map<const Refinement*, std::vector<double>> gains_;  ///< of every row, by draw
  double median_ = 0;                                       ///< rms gain of the median row
  std::vector<double> always_, in_units_, events_;          ///< largest, by draw
  std::array<double, 2> mean_events_{};                     ///< that last, that pass
};

}  // namespace cablefit
