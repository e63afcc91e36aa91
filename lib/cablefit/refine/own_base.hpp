// The models that refine begins with when none is given, or what a given one lacks. Only their
// structure and their cables count: all linear parameters are fitted to refine's own rows before
// anything is looked for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

struct OwnBase {
  std::vector<Model> models;  ///< one per preload, in the order in which they come
  std::vector<Decision> decisions;
  ElongationCovariance elongations = {};  ///< of l_o that were searched
};

/// Of the training and blocked logs: a rigid drive where no log has q, or q is a copy of theta.
/// Else cables by stage 1 from the blocked logs, l_o searched where their curve asks for it (all
/// preloads of one order, so that they share coefficients), or by one step from the moving logs
/// where no link is blocked; where such cables do not explain these, one straight spring. The
/// effects are those of stage 2. Throws Error(input) for missing channels, and
/// what the stages throw.
OwnBase own_base(const RefineLogs& logs, int threads);

/// The same with one straight spring in place of its cables; the decision says `why`.
OwnBase with_spring(OwnBase base, const std::string& why);

/// Why a start value has no sd; a fit takes the text away with the value.
inline constexpr std::string_view kStartValue = "a start value";
inline constexpr std::string_view kSpringName = "K";
/// What is said where the sd do not hold the error of a searched l_o.
inline constexpr const char* kElongationsHeld =
    "the sd of stiffness and inertia do not include the error of the searched l_o; 'cablefit "
    "identify' gives intervals that do";
/// Name of the decision about cables or a spring.
inline constexpr const char* kCablesChoice = "cables";

/// A missing value of an effect becomes the rig's "cad", else its bound; a missing inertia 1.
/// refine estimates all of them. Returns which were missing.
std::vector<Decision> fill_start_values(std::vector<Model>& models);

}  // namespace cablefit
