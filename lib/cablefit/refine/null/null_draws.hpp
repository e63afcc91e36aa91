// The search under the null. Logs simulated from the fitted base model, with the same reference,
// controller, clock, rounding and noise, pass the same pipeline (parametric bootstrap; Efron &
// Tibshirani 1993). Noise models of the residual alone are not sufficient: gains under the null
// come from filters at reversals and from rounding. Internal to refine/.
#pragma once

#include <map>
#include <memory>
#include <span>

#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/refine/search/scan.hpp"

namespace cablefit {

/// One simulated data set, searched.
struct NullDraw {
  KindLevels floor{};                     ///< rms of the base model's residual
  std::map<const Effect*, double> gains;  ///< best of each row; events in sample
};

/// A base fit in two iterations: weights from its own residual (or `levels`), states from its
/// values.
struct BaseFit {
  Design design;
  BlockGrams grams;
  BlockFit fit;
  KindLevels levels{};
};
BaseFit fit_base(Design design, double block_seconds, const KindLevels* levels);

class NullBench {
 public:
  /// `models`: fitted, one per preload. `logs`: those of the search. `threads`: for the simulation,
  /// here and below; the draws do not depend on it. Throws Error(not_identifiable) when the base
  /// cannot be simulated.
  NullBench(std::span<const Model> models, std::span<const LogSurvey> logs,
            const PartFilter& wanted, const Smoothing& smoothing, int threads);
  ~NullBench();
  NullBench(const NullBench&) = delete;
  NullBench& operator=(const NullBench&) = delete;

  /// Sets torques that later draws have besides the model's, see remainder.hpp.
  void disturb(const CopyDisturbance& disturbance);

  /// Later draws hold back this share (0..1) from the search, as is done with the logs: gains under
  /// the null grow when rows are fewer.
  void hold_back(double share);

  /// Later draws log torques without noise, to show errors that are not random.
  void silence_torque();

  /// Whether the draws follow the measured motion. They do where the rig's controller with the
  /// logs' reference does not move the model as the robot moved, for example because a torque was
  /// added to its command, or where the loop is not stable.
  bool follows() const;

  /// One draw as logs, by model.
  struct Recorded {
    std::size_t model = 0;
    std::vector<LogSurvey> logs;
  };
  std::vector<Recorded> record(std::uint64_t seed, int threads = 1) const;
  /// As above, as stretches, numbered as the logs that the bench was made from.
  std::vector<Stretch> draw(std::uint64_t seed, int threads = 1) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cablefit
