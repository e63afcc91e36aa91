// The models that refine starts from when none is given, or values that a given one lacks. Only
// their structure and their cables count: all linear parameters are fitted to refine's own rows
// before any search.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

struct OwnBase {
  std::vector<Model> models;  ///< one per preload, in the order in which they occur
  std::vector<Decision> decisions;
  ElongationCovariance elongations = {};  ///< of the l_o that were searched
};

/// Base models from the training and blocked logs. A rigid drive where no log has q, or q is a copy
/// of theta. Otherwise cables by stage 1 from the blocked logs, with l_o searched where their curve
/// requires it (one order for all preloads, so that they share coefficients). Without a blocked
/// link, cables by the one-step identification from the moving logs. Where such cables do not
/// explain the moving logs, one straight spring. The effects are those of stage 2. Throws
/// Error(input) for missing channels, and the errors of the stages.
OwnBase own_base(const RefineLogs& logs, int threads);

/// The same with one straight spring instead of its cables. `why` is the reason in the decision.
OwnBase with_spring(OwnBase base, const std::string& why);

/// Why a start value has no sd. A fit removes this text together with the value.
inline constexpr std::string_view kStartValue = "a start value";
inline constexpr std::string_view kSpringName = "K";
/// The warning where the sd do not include the error of a searched l_o.
inline constexpr const char* kElongationsHeld =
    "the sd of stiffness and inertia do not include the error of the searched l_o; 'cablefit "
    "identify' gives intervals that do";
/// Name of the decision between cables and a spring.
inline constexpr const char* kCablesChoice = "cables";

/// A missing value of an effect becomes the rig's "cad", else its bound; a missing inertia becomes
/// 1. refine estimates all of them. Returns which were missing.
std::vector<Decision> fill_start_values(std::vector<Model>& models);

}  // namespace cablefit
