// Looking for a reference trajectory: of a shape, within limits, the one with the smallest value of
// an objective. What the objective is, is the caller's: the worst relative sd of stage 2, or how
// little two models differ on the motion.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/design/excitation/excited_motion.hpp"
#include "cablefit/design/excitation/motion_shapes.hpp"

namespace cablefit {

/// To be minimised; infinite for a motion that is of no use. Called from several threads at a time.
using ExcitationObjective = std::function<double(const ExcitedMotion&)>;

struct ExcitationOptions {
  ExcitationLimits limits;
  std::string shape = "multisine";  ///< name of the table
  unsigned long seed = 1;
  int n_random = 24;       ///< motions drawn at random first
  int n_generations = 30;  ///< of changes to the best one
  int per_generation = 8;
  int threads = 1;            ///< the result does not depend on it
  Eigen::ArrayXXd from = {};  ///< numbers of an earlier search to go on from; nothing is drawn then
};

struct Excitation {
  ExcitedMotion motion;     ///< simulated with the simulator's own step
  double objective = 0;     ///< of that
  Eigen::ArrayXXd numbers;  ///< of the shape, a column per joint
  int n_tried = 0;
  double hz = 0;  ///< of a sine
};

/// Draws motions at random, adds those the shape starts from, and then changes the best one at
/// random, by steps that grow when they help and shrink when not (an evolution strategy with a 1/5
/// rule, Rechenberg 1973). The same seed gives the same motion. `model` has a controller
/// (excitable()). Throws Error(not_identifiable) when none of the motions drawn stays within the
/// limits or is of use.
Excitation search_excitation(const Model& model, const ExcitationOptions& options,
                             const ExcitationObjective& objective);

/// One sine that uses all of the range at the highest speed, as far as the torque allows it: what
/// is recorded when nobody plans.
Excitation plain_sine(const Model& model, const ExcitationOptions& options,
                      const ExcitationObjective& objective);
/// The best of 16 frequencies of one sine that uses the limits to the full.
Excitation best_sine(const Model& model, const ExcitationOptions& options,
                     const ExcitationObjective& objective);

/// Some motion of the shape within the limits: the first of those drawn at random. Throws as above.
ExcitedMotion any_motion(const Model& model, const ExcitationOptions& options);

}  // namespace cablefit
