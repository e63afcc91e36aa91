// Several joints: each is refined by its own equations, in which the measured motion of the others
// is given (model/one_joint.hpp), so that what is missing on one joint does not look like an effect
// of another. Internal to refine/.
#pragma once

#include <functional>
#include <span>

#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Refines models of one joint each.
using RefineOne =
    std::function<RefineResult(std::span<const Model>, const RefineLogs&, const RefineOptions&)>;

/// A joint after the other. The significance that one joint needs is that of all over their number
/// (Bonferroni 1936). A joint that cannot be refined does not keep the others from it. Throws what
/// one joint throws where it is the same for all of them.
RefineResult refine_joints(std::span<const Model> models, const RefineLogs& logs,
                           const RefineOptions& options, const RefineOne& refine_one);

}  // namespace cablefit
