// Recordings as sensors and drives that are as they should be would have left them, by the
// refinements of a model. Internal to simulate/.
#pragma once

#include "cablefit/model/model.hpp"
#include "cablefit/samples/survey/windows.hpp"

namespace cablefit {

/// Rows on either side that a correction may look at: the longest delay (effects.hpp) at a few
/// kHz.
inline constexpr Eigen::Index kCorrectionHalo = 128;

/// Some refinement of the model corrects recordings.
bool corrects(const Model& model);
/// The rows of a joint that correct recordings, one after the other.
void correct(const std::vector<EffectInstance>& refinements, Recording& recording);
/// Corrects the channels of the window, joint by joint. `commands`: tau is left alone, being the
/// command that a closed loop gives as well.
void correct(const Model& model, const LogPlan& plan, bool commands, Window& window);

}  // namespace cablefit
