#include "cablefit/samples/weigh/weigh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit {
namespace {

struct WeighingRow {
  weighing::Findings (*find)(const weighing::Logs&);
  bool of_samples;     ///< needs no block means, which a wrong clock or a spike would spoil
  bool explains_rest;  ///< what is found makes later findings meaningless
};

/// Causes before their consequences.
constexpr std::array<WeighingRow, 9> kWeighings = {{{weighing::clock, true, true},
                                                    {weighing::spikes, true, true},
                                                    {weighing::positions, false, true},
                                                    {weighing::velocity, false, false},
                                                    {weighing::work, false, true},
                                                    {weighing::deflection, false, true},
                                                    {weighing::blocked_slope, false, true},
                                                    {weighing::load_balance, false, true},
                                                    {weighing::duplicates, false, false}}};

/// One rig file's mistake shows in each of its logs; it is told of the first.
std::string with_count(const std::string& what, std::size_t others) {
  if (others == 0) return what;
  return fmt::format("{} (and {} more log{})", what, others, others == 1 ? "" : "s");
}

void take(std::vector<LogSurvey>& logs, const weighing::Findings& findings, bool only_first) {
  std::set<std::size_t> told;
  for (const Finding& finding : findings) told.insert(finding.log);
  for (const Finding& finding : findings) {
    LogSurvey& log = logs[finding.log];
    const std::string what =
        with_count(finding.what, only_first && finding.wrong ? told.size() - 1 : 0);
    const Error error = input_error({log.plan.path, finding.line, 0}, what, finding.remedy);
    if (finding.hopeless || (finding.wrong && !log.plan.reading.trust_units)) throw error;
    log.warnings.emplace_back(error.what());
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
