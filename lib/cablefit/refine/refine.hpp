// Where do model and measurement disagree, which effect is missing, and does the gap shrink on data
// that it was not fitted to? The decision rule is in two files: verdict.cpp, conclusion.cpp.
//
// Method. Rows of the blocked, link and motor equations (base_rows.hpp) of all training logs are
// fitted jointly; every row of the catalogue is tried as further columns with everything refitted
// (never on a frozen base: Brynjarsdottir & O'Hagan 2014) and judged on held-out blocks of time.
// The null distribution of such a search comes from logs simulated from the fitted base
// (null_draws.hpp). The test logs are read once, in the end (test_reading.hpp): they may take a
// term away, not choose another.
#pragma once

#include <span>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// What the models have from an earlier refinement is part of the base and fitted anew with it
/// (kept_effects.hpp).
/// `models`: one per preload, of the same structure, fitted to these or similar logs; coefficients
/// of cables are shared between preloads, l_o are not. Of several joints each is refined for itself
/// (joints.hpp). Throws Error(input) for missing channels and coupled links,
/// Error(not_identifiable) where the base cannot be fitted or simulated.
RefineResult refine(std::span<const Model> models, const RefineLogs& logs,
                    const RefineOptions& options);

}  // namespace cablefit
