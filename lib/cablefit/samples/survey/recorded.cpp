#include "cablefit/samples/survey/recorded.hpp"

#include <memory>

namespace cablefit {
namespace {

/// Rows that the pieces of the store have, so that whoever reads one holds little in memory.
constexpr Eigen::Index kPieceRows = 8192;

/// Channels between jumps of the clock, across which nothing is differenced.
void scan_rows(const LogPlan& plan, const Eigen::MatrixXd& rows, ClockScan& clock,
               std::vector<ChannelScan>& channels) {
  const auto look_at = [&](Eigen::Index begin, Eigen::Index end) {
    if (begin == end) return;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      channels[k].restart();
      channels[k].add(
          rows.col(static_cast<Eigen::Index>(k) + 1).segment(begin, end - begin).array());
    }
  };
  Eigen::Index smooth = 0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto line = static_cast<std::uint64_t>(i) + 1;
    if (!clock.add(rows(i, 0), i > 0, plan.path, line)) continue;
    look_at(smooth, i);
    smooth = i;
  }
  look_at(smooth, rows.rows());
}

PartSurvey survey_part(const LogPlan& plan, const RecordedPart& recorded) {
  ClockScan clock;
  std::vector<ChannelScan> channels(plan.slots.size());
  scan_rows(plan, recorded.rows, clock, channels);
  PartSurvey part{clock.result(), recorded.preload,     recorded.run,
                  recorded.phase, recorded.phase_given, {}};
  for (const ChannelScan& channel : channels) part.channels.push_back(channel.result());
  return part;
}

}  // namespace

LogSurvey survey_recorded(const LogPlan& plan, const std::vector<RecordedPart>& parts) {
  auto samples = std::make_shared<SampleStore>();
  LogSurvey survey;
  survey.plan = plan;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Eigen::MatrixXd& rows = parts[k].rows;
    survey.parts.push_back(survey_part(plan, parts[k]));
    survey.n_rows += static_cast<std::size_t>(rows.rows());
    for (Eigen::Index begin = 0; begin < rows.rows(); begin += kPieceRows)
      samples->append(k, begin > 0,
                      rows.middleRows(begin, std::min(kPieceRows, rows.rows() - begin)));
  }
  survey.samples = std::move(samples);
  return survey;
}

LogPlan recorded_plan(const std::string& name, const Rig& rig,
                      const std::vector<Channel>& channels) {
  LogPlan plan;
  plan.path = name;
  plan.rig = rig;
  plan.header.path = name;
  plan.header.columns.push_back({"t", "s", {name, 1, 0}});
  for (const Channel channel : channels) {
    plan.slots.push_back({channel, 0, plan.header.columns.size(), 1, 0});
    plan.header.columns.push_back({std::string(channel_name(channel)), "", {name, 1, 0}});
  }
  plan.time_column = 0;
  return plan;
}

}  // namespace cablefit
