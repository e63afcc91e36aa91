#include "cablefit/samples/weigh/weigh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "cablefit/samples/survey/phases.hpp"
#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit {
namespace {

struct WeighingRow {
  weighing::Findings (*find)(const weighing::Logs&);
  bool of_samples;     ///< needs no block means, which a wrong clock or a spike would spoil
  bool explains_rest;  ///< what is found makes later findings meaningless
};

/// Causes before their consequences.
constexpr std::array<WeighingRow, 15> kWeighings = {{{weighing::clock, true, true},
                                                     {weighing::spikes, true, true},
                                                     {weighing::jumps, true, true},
                                                     {weighing::swapped_joints, false, true},
                                                     {weighing::positions, false, true},
                                                     {weighing::velocity, false, false},
                                                     {weighing::reference, false, false},
                                                     {weighing::work, false, true},
                                                     {weighing::deflection, false, true},
                                                     {weighing::blocked_slope, false, true},
                                                     {weighing::reversed_joints, false, true},
                                                     {weighing::load_balance, false, true},
                                                     {weighing::saturation, true, false},
                                                     {weighing::duplicates, false, false},
                                                     {weighing::overlaps, true, false}}};

/// A mistake in a rig file shows in each of its logs. Only the first is reported.
std::string with_count(const std::string& what, std::size_t others) {
  if (others == 0) return what;
  return fmt::format("{} (and {} more log{})", what, others, others == 1 ? "" : "s");
}

/// Whether another log with the same rig file and the same kind of parts is right as it is.
bool others_are_right(const std::vector<LogSurvey>& logs, const std::set<std::size_t>& reported,
                      const Finding& finding) {
  if (finding.whole_rig) return false;
  const LogSurvey& wrong = logs[finding.log];
  for (std::size_t k = 0; k < logs.size(); ++k)
    if (!reported.contains(k) && logs[k].plan.rig.path == wrong.plan.rig.path &&
        has_phase(logs[k], Phase::moving) == has_phase(wrong, Phase::moving))
      return true;
  return false;
}

std::string remedy_of(const std::vector<LogSurvey>& logs, const std::set<std::size_t>& reported,
                      const Finding& finding) {
  if (finding.row || !finding.wrong || !others_are_right(logs, reported, finding))
    return finding.remedy;
  return finding.remedy + "; of this log alone: give it a folder and a rig.json of its own";
}

void take(std::vector<LogSurvey>& logs, const weighing::Findings& findings, bool only_first) {
  std::set<std::size_t> reported, warned;  // one odd thing of each log is enough
  for (const Finding& finding : findings) reported.insert(finding.log);
  for (const Finding& finding : findings) {
    LogSurvey& log = logs[finding.log];
    if (!finding.wrong && !warned.insert(finding.log).second) continue;
    const std::string what =
        with_count(finding.what, only_first && finding.wrong ? reported.size() - 1 : 0);
    const std::uint64_t line = finding.row ? line_of_row(log.plan, *finding.row) : 0;
    const Error error =
        input_error({log.plan.path, line, 0}, what, remedy_of(logs, reported, finding));
    if (finding.always_refused || (finding.wrong && !log.plan.reading.trust_units)) throw error;
    log.warnings.emplace_back(error.what());
    log.has_trusted_finding = log.has_trusted_finding || (finding.wrong && only_first);
    if (only_first && finding.wrong) return;
  }
}

}  // namespace

void weigh_logs(std::vector<LogSurvey>& logs) {
  std::vector<CoarsePart> parts;
  for (const WeighingRow& row : kWeighings) {
    if (!row.of_samples && parts.empty()) parts = coarse_parts(logs);
    const weighing::Findings findings = row.find({logs, parts});
    take(logs, findings, row.explains_rest);
    const bool wrong = std::any_of(findings.begin(), findings.end(),
                                   [](const Finding& finding) { return finding.wrong; });
    if (wrong && row.explains_rest) return;
  }
}

}  // namespace cablefit
