// The story of a refinement in about ten lines. Internal to report/.
#pragma once

#include "cablefit/base/axes.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Headline refine_headline(const RefineResult& result);
std::vector<SummaryLine> refine_story(const RefineResult& result,
                                      const std::vector<std::string>& model_files);

/// Smaller p-values of a test are not printed: so far out no distribution is known.
inline constexpr double kLeastTestP = 1e-6;

/// "motor", of one of several joints "motor 2".
std::string side_text(std::string_view side, int joint, const RefineResult& result);
/// "stribeck (motor)", "stribeck (motor 2)".
std::string effect_text(std::string_view name, std::string_view side, int joint,
                        const RefineResult& result);
/// With the cable of a wrong radius: "cable_radius[flexor] (link 2)".
std::string effect_text(const NamedEffect& effect, const RefineResult& result);

/// "thetad from -0.386 to 0.208 rad/s", "negative direction of thetad".
std::string regime_text(const Regime& regime, Axes axes);

/// How many sd a parameter moved; NaN without an sd.
double moved_sd(const ParameterShift& shift);
/// Whether that is worth a word: by its sd, or where that is not known by its size.
bool is_shifted(const ParameterShift& shift);

}  // namespace cablefit
