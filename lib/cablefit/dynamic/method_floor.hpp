// What filter, differences, sampling and rounding do to the estimates when nothing disturbs the
// drive: an error that no residual shows and no longer log removes.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/dynamic_job.hpp"

namespace cablefit {

/// Mean squared error of every effect's parameters, per equation, in the square of their units;
/// empty where the motion could not be simulated.
struct MethodFloor {
  std::vector<Eigen::VectorXd> variance;
  std::string note;  ///< how it was measured, or why it was not

  bool is_known() const { return !variance.empty(); }
};

/// Simulates the measured motion with the model that `solutions` (one per equation) make of model
/// number `which`, without disturbances, with sensors that round as those of the logs do, and fits
/// that copy by the same filter, decimation and masks: what comes out differs from what went in by
/// the method alone. Rounding is drawn kFloorDraws times, by fixed seeds. `with_instruments`, per
/// equation: instruments keep rounding out, so that the positions of the copy are exact there. At
/// most kFloorRows rows, in stretches over all logs. Not for arms whose links move each other.
MethodFloor method_floor(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& solutions,
                         const std::vector<bool>& with_instruments, std::size_t which);

inline constexpr int kFloorDraws = 3;
inline constexpr double kFloorRows = 100000;

}  // namespace cablefit
