// Data sets of the second simulator (tests/hidden) as logs in memory.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cablefit/refine/refine.hpp"
#include "tests/hidden/design.hpp"

namespace cablefit::test {

struct HiddenLogs {
  RefineLogs logs;
  std::vector<Model> models;  ///< the bench without the effect
  hidden::Case truth;
};

/// `effects`: "stribeck.motor=0.3", as hidden_data has them. Each is of the design "short", runs of
/// 6 s, unless it says otherwise.
HiddenLogs hidden_logs(const std::vector<std::string>& effects, unsigned long seed = 1,
                       const std::string& design = "short", double clutter = 0);

/// A row of the catalogue with these values of its parameters.
EffectInstance effect_at(std::string_view name, Site site, const std::vector<double>& values);

/// The blocked logs and those to train on.
std::vector<LogSurvey> all_training(const RefineLogs& logs);

}  // namespace cablefit::test
