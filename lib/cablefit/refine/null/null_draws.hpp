// What the whole search finds where there is nothing to find: logs simulated from the fitted base
// model, with the same reference, controller, clock, rounding and noise, go through the same
// pipeline (parametric bootstrap; Efron & Tibshirani 1993). Noise models of the residual alone
// under-state it: the gains of a search under the null are made by filters at reversals and by
// rounding. Internal to refine/.
#pragma once

#include <map>
#include <memory>
#include <span>

#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/refine/search/scan.hpp"

namespace cablefit {

/// One simulated data set, searched.
struct NullDraw {
  KindLevels floor{};                     ///< rms the base model leaves
  std::map<const Effect*, double> gains;  ///< best of each row; events in sample
};

/// A base fit iterated twice: weights from its own residual (or `levels`), states from its values.
struct BaseFit {
  Design design;
  BlockGrams grams;
  BlockFit fit;
  KindLevels levels{};
};
BaseFit fit_base(Design design, double block_seconds, const KindLevels* levels);

class NullBench {
 public:
  /// `models`: fitted, one per preload. `logs`: as the search sees them. Throws
  /// Error(not_identifiable) when the base cannot be simulated. `threads`: to simulate with, here
  /// and below; the draws are the same whatever their number.
  NullBench(std::span<const Model> models, std::span<const LogSurvey> logs,
            const PartFilter& wanted, const Smoothing& smoothing, int threads);
  ~NullBench();
  NullBench(const NullBench&) = delete;
  NullBench& operator=(const NullBench&) = delete;

  /// Torques that the draws from now on have beside the model, see remainder.hpp.
  void disturb(const CopyDisturbance& disturbance);

  /// Of every draw from now on this share (0..1) is kept from the search, as it is of the logs:
  /// gains under the null grow as rows are fewer.
  void hold_back(double share);

  /// Torques are logged without noise from now on, which leaves what is not chance.
  void silence_torque();

  /// The rig's controller with the logs' reference does not move the model as the robot moved, as
  /// where a torque was added to its command: the draws follow the measured motion instead.
  bool follows() const;

  /// One draw as logs, by model.
  struct Recorded {
    std::size_t model = 0;
    std::vector<LogSurvey> logs;
  };
  std::vector<Recorded> record(std::uint64_t seed, int threads = 1) const;
  /// The same as stretches, numbered as the logs that the bench was made from.
  std::vector<Stretch> draw(std::uint64_t seed, int threads = 1) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cablefit
