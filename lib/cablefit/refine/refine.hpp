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

#include <functional>
#include <optional>
#include <span>

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/samples/survey.hpp"

namespace cablefit {

struct RefineOptions {
  std::size_t n_draws = 24;        ///< simulated data sets
  unsigned long seed = 1;          ///< of the first; counted up from there
  double materiality = 0.01;       ///< least share of the squared residual that is worth a name
  std::optional<double> material;  ///< N m that matter; nothing: see material_torque()
  double significance = 0.01;      ///< largest p value of a name
  std::size_t most_effects = 3;
  int threads = 1;
  bool figures = false;
  std::function<void(std::string_view what, double share)> progress;
};

/// Which logs are for what. Without test logs the last third of every moving log is held out.
struct RefineLogs {
  std::vector<LogSurvey> train, test, blocked;
};

/// What the models have from an earlier refinement is part of the base and fitted anew with it
/// (kept_effects.hpp).
/// `models`: one per preload, of the same structure, fitted to about these logs; coefficients of
/// cables are shared between preloads, l_o are not. Throws Error(input) for missing channels and
/// several joints, Error(not_identifiable) where the base cannot be fitted or simulated.
RefineResult refine(std::span<const Model> models, const RefineLogs& logs,
                    const RefineOptions& options);

}  // namespace cablefit
