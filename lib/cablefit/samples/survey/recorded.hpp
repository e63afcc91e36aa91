// A log that never was a file: samples in SI, surveyed as if they had been read.
#pragma once

#include <string>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// One part of such a log.
struct RecordedPart {
  std::string preload, run;
  Phase phase = Phase::moving;
  bool phase_given = true;
  /// n x (1 + slots) as [t, slots of the LogPlan], SI; t in s, ascending.
  Eigen::MatrixXd rows;
};

/// `plan`: rig and slots of the log; its path is a name for messages, no file is opened. Throws
/// Error(input) for time that stands still or runs back.
LogSurvey survey_recorded(const LogPlan& plan, const std::vector<RecordedPart>& parts);

/// A plan for columns that come in this order, of one joint.
LogPlan recorded_plan(const std::string& name, const Rig& rig,
                      const std::vector<Channel>& channels);

}  // namespace cablefit
