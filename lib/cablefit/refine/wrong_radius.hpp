// A pulley whose radius is not that of the rig file, or a joint that a cable moves though the rig
// file says that it does not. Every joint that the cable passes shows it, by the motion of the
// pulley's joint. Internal to refine/.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cablefit/refine/radius_fit.hpp"

namespace cablefit {

struct WrongRadius {
  Pulley pulley;
  double given = 0, radius = 0, sd = 0;  ///< m, signed
  double dof = 1;                        ///< of the t distribution of the radius
  double chance = 1;  ///< of such a difference where no radius is wrong, over all pulleys
  double share = 0;   ///< of the squared residual that the right radius removes, on held-out blocks
  std::vector<Pulley> rivals;  ///< whose radius explains the logs as well
};

/// The pulley whose radius explains most. Nothing where none is significant.
std::optional<WrongRadius> wrong_radius(const std::vector<Model>& models, const RefineLogs& logs,
                                        double significance);

/// The given models with the right radius. It is fitted again with the weights that the rows have
/// then; the first ones had the gap of the wrong radius in them.
std::vector<Model> with_right_radius(std::span<const Model> given, const RefineLogs& logs,
                                     int threads, WrongRadius& wrong);

}  // namespace cablefit
