// A model as the start of 'cablefit dynamic': its cables are stage 1, and what it has beyond the
// paper's equations is fitted with the rest.
#pragma once

#include <optional>

#include "cablefit/dynamic/dynamic_options.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/identify/identify_options.hpp"
#include "cablefit/model/model.hpp"
#include "options/common_options.hpp"

namespace cablefit::apps {

struct StartModel {
  std::string path, choice;
  Model model;
};

/// Takes a model from the front of the logs, where there is one. `fit_name`: of a result's models
/// the one wanted; empty: as read_model().
std::optional<StartModel> take_model(CommonOptions& options, const std::string& fit_name);

/// Logs of the bench that the model is of; without a rig file of their own they take the model's.
std::vector<LogSurvey> read_logs_of(const StartModel& start, const CommonOptions& options);

/// The kind of model and its effects.
void use_model(const StartModel& start, DynamicOptions& fit);

/// Its effects, and the order of its cables where the rig does not give them.
void use_model(const StartModel& start, IdentifyOptions& fit);

/// "K1_0, K1_1": coefficients of its cables without sd, whose error no sd of the fit has.
std::string missing_sd(const Model& model);

/// Its cables as a result of stage 1; nothing of a rigid drive.
ElasticResult stage1_of(const StartModel& start);

}  // namespace cablefit::apps
