// Options and logs of refine.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/model/elongation_covariance.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

struct RefineOptions {
  std::size_t n_draws = 24;   ///< simulated data sets
  unsigned long seed = 1;     ///< combined with the contents of the training logs
  double materiality = 0.01;  ///< smallest share of the squared residual of an identified effect
  std::optional<double> material;  ///< N m that matter; nothing: see materiality.hpp
  double significance = 0.01;      ///< largest p-value of an identified effect
  std::size_t most_effects = 3;
  std::string preload;  ///< only this one, of the models that are fitted to the logs; empty: all
  ElongationCovariance elongations;  ///< of the models' l_o that were searched
  int threads = 1;
  bool figures = false;
  std::function<void(std::string_view what, double share)> progress;
};

/// The use of each log. Without test logs the last third of every moving log is held out.
struct RefineLogs {
  std::vector<LogSurvey> train, test, blocked;

  /// Blocked logs, then training logs.
  std::vector<LogSurvey> fitted() const;
};

}  // namespace cablefit
