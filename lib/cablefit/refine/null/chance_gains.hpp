// Gains of searches in simulated data sets without an effect. A search of the logs must exceed
// them. Internal to refine/.
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

  /// p-value: P that the largest gain of all effects that are no events is this large under the
  /// null.
  ChanceTail tail_of_search(double gain) const;

  /// The p-value of one row's gain. Effects that are no events are judged in two ways, and the
  /// result is twice the smaller p-value (Bonferroni; not where no draws could give a smaller one).
  /// One way uses the gain itself. The other divides it by the row's own usual gain under the null
  /// (studentized maximum; Westfall & Young 1993): where one equation has a disturbance, the rows
  /// that act there gain much and the others do not. Events are compared with events.
  ChanceTail tail(const Effect& row, double share) const;

  /// Whether the gain is more than `times` the largest of all draws, in one of these ways.
  bool is_beyond(const Effect& row, double share, double times) const;

  /// Usual gain under the null. For an event it is that of the best event of its kind (lasting or
  /// passing), otherwise that of the row itself. 0 without draws.
  double usual(const Effect& row) const;

 private:
  /// rms of a row's gains in all draws except `but`.
  double rms_without(const Effect& row, std::size_t but) const;
  double unit(const Effect& row, std::size_t but) const;

  std::map<const Effect*, std::vector<double>> gains_;  ///< log ratios, of every row, by draw
  double median_ = 0;                                   ///< rms gain of the median row
  std::vector<double> always_, in_units_, events_;      ///< largest gain, by draw
  std::array<double, 2> mean_events_{};                 ///< of lasting and of passing events
};

}  // namespace cablefit
