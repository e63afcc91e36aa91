// What searches of simulated data sets without an effect gain, which a search of the logs has to
// beat. Internal to refine/.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "cablefit/refine/null/chance_tail.hpp"
#include "cablefit/refine/null/null_draws.hpp"

namespace cablefit {

class ChanceGains {
 public:
  explicit ChanceGains(const std::vector<NullDraw>& draws);

  std::size_t n_draws() const { return always_.size(); }

  /// P that the largest gain of all that is always there is this large under the null.
  ChanceTail tail_of_search(double gain) const;

  /// The same of one row's gain. Of what is always there two ways, and twice the smaller
  /// (Bonferroni; not where no draws could show less): as it is, and in units of what its own row
  /// gains under the null, as rows that act where one equation has a disturbance gain much and the
  /// others do not (studentized maximum; Westfall & Young 1993). Events compete with events.
  ChanceTail tail(const Effect& row, double share) const;

  /// Whether it is more than `times` the largest of all draws, in one of these ways.
  bool is_beyond(const Effect& row, double share, double times) const;

  /// Usual gain under the null: of the row itself, of the event with the largest gain that
  /// lasts, or that passes. 0 without draws.
  double usual(const Effect& row) const;

 private:
  /// rms of the gains of a row in all draws but `but`.
  double rms_without(const Effect& row, std::size_t but) const;
  double unit(const Effect& row, std::size_t but) const;

  std::map<const Effect*, std::vector<double>> gains_;  ///< log ratios, of every row, by draw
  double median_ = 0;                                   ///< rms gain of the median row
  std::vector<double> always_, in_units_, events_;      ///< largest, by draw
  std::array<double, 2> mean_events_{};                 ///< that last, that pass
};

}  // namespace cablefit
