// Logs of the truth simulator without a file between.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cablefit/samples/survey/recorded.hpp"
#include "tests/truth/rig.hpp"

namespace cablefit::test {

/// The columns that the log has, all rows one moving part.
inline LogSurvey survey_of(const truth::Log& log, const Rig& rig,
                           const std::string& preload = "default") {
  std::vector<std::pair<Channel, const std::vector<double>*>> columns = {
      {Channel::q, &log.q},
      {Channel::theta, &log.theta},
      {Channel::tau, &log.tau},
      {Channel::tau_load, &log.tau_load},
      {Channel::theta_ref, &log.theta_ref}};
  std::erase_if(columns, [](const auto& column) { return column.second->empty(); });
  const auto as_vector = [](const std::vector<double>& x) {
    return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  };
  RecordedPart part{preload, "", Phase::moving, true, {}};
  part.rows.resize(static_cast<Eigen::Index>(log.t.size()),
                   static_cast<Eigen::Index>(1 + columns.size()));
  part.rows.col(0) = as_vector(log.t);
  std::vector<Channel> channels;
  for (const auto& [channel, values] : columns) {
    channels.push_back(channel);
    part.rows.col(static_cast<Eigen::Index>(channels.size())) = as_vector(*values);
  }
  return survey_recorded(recorded_plan("simulated", rig, channels), {part});
}

}  // namespace cablefit::test
