// Where do model and measurement disagree, which effect is missing, and does it reduce the residual
// on data that it was not fitted to? The decision rule is in two files: verdict.cpp,
// conclusion.cpp.
//
// Method. Rows of the blocked, link and motor equations (base_rows.hpp) of all training logs are
// fitted jointly. Every row of the catalogue is tried as further columns, with all parameters
// refitted (never on a frozen base: Brynjarsdottir & O'Hagan 2014), and judged on held-out blocks
// of time. The null distribution of this search comes from logs simulated with the fitted base
// (null_draws.hpp). The test logs are read once, at the end (test_reading.hpp): they may remove an
// effect, not choose another.
#pragma once

#include <span>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Effects that the models have from an earlier refinement are part of the base and are fitted anew
/// with it (kept_effects.hpp). `models`: one per preload, of the same structure, fitted to these or
/// similar logs. Preloads share the coefficients of cables, not l_o. With several joints each is
/// refined separately (joints.hpp). Throws Error(input) for missing channels and coupled links, and
/// Error(not_identifiable) where the base cannot be fitted or simulated.
RefineResult refine(std::span<const Model> models, const RefineLogs& logs,
                    const RefineOptions& options);

}  // namespace cablefit
