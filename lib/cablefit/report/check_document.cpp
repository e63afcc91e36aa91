#include "cablefit/report/check_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "cablefit/report/document_parts.hpp"
#include "cablefit/report/numbers.hpp"

namespace cablefit {
namespace {

constexpr int kDigits = 4;
constexpr double kDegrees = 180 / 3.14159265358979323846;

/// How a part is called within its log.
std::string part_name(const CheckedPart& part) {
  const PartSurvey& s = part.survey;
  return s.run.empty() ? s.preload : s.preload + ", run " + s.run;
}

/// A printed time is rounded: less than 0.001 % of jitter is none.
std::string percent(double share) { return share < 1e-5 ? "0" : significant(100 * share, 2); }

Table parts_table(const CheckedLog& log) {
  Table table;
  table.title = fmt::format("{}: {} rows", log.path, log.rows);
  table.columns = {{"", "part", "", true},
                   {"", "phase", "", true},
                   {"", "rows", ""},
                   {"", "duration", "s"},
                   {"clock", "rate", "Hz"},
                   {"clock", "jitter", "%"},
                   {"clock", "worst", "%"},
                   {"clock", "gaps", ""},
                   {"motion", "at rest", "%"},
                   {"motion", "fastest", log.linear_motion ? "m/s" : "rad/s"},
                   {"motion", "speeds", "of 10"},
                   {"", "good for", "", true}};
  for (const CheckedPart& part : log.parts) {
    const PartSurvey& s = part.survey;
    const Excitation& e = part.excitation;
    const bool known = !e.channel.empty();
    table.rows.push_back(
        {part_name(part), std::string(to_string(s.phase)), fmt::format("{}", s.n_rows),
         significant(s.t_last - s.t_first, kDigits), significant(1 / s.period, kDigits),
         percent(s.jitter), percent(s.worst_jitter), fmt::format("{}", s.n_gaps),
         known ? percent(e.share_at_rest) : kNoNumber,
         known ? significant(e.fastest, 3) : kNoNumber,
         known ? fmt::format("{}", e.speed_bands) : kNoNumber,
         part.identifies.empty() ? "nothing"
                                 : fmt::format("{}", fmt::join(part.identifies, ", "))});
  }
  if (!log.unused_columns.empty()) {
    table.notes.push_back(fmt::format("not used: {}", fmt::join(log.unused_columns, ", ")));
  }
  return table;
}

Table channels_table(const CheckedLog& log) {
  Table table;
  table.columns = {{"", "part", "", true}, {"", "channel", "", true}, {"", "unit", "", true},
                   {"", "min", ""},        {"", "max", ""},           {"", "range", "deg"},
                   {"", "quantum", ""},    {"", "noise sd", ""},      {"", "at limits", "%"}};
  for (const CheckedPart& part : log.parts) {
    for (const CheckedChannel& channel : part.channels) {
      const ChannelSurvey& s = channel.survey;
      table.rows.push_back({part_name(part), channel.name, channel.unit,
                            significant(s.min, kDigits), significant(s.max, kDigits),
                            channel.is_angle ? significant(kDegrees * s.range(), 3) : kNoNumber,
                            significant(s.quantum, 2), significant(s.noise, 2),
                            percent(s.at_limits)});
    }
  }
  return table;
}

Table tidy_check_table() {
  Table table;
  for (const char* name : {"log", "preload", "run", "phase", "rows", "rate", "channel", "unit",
                           "min", "max", "quantum", "noise", "share_at_limits", "good_for"}) {
    table.columns.push_back({"", name, ""});
  }
  return table;
}

void add_tidy_rows(Table& table, const CheckedLog& log, const CheckedPart& part) {
  const PartSurvey& p = part.survey;
  for (const CheckedChannel& channel : part.channels) {
    const ChannelSurvey& s = channel.survey;
    table.rows.push_back({log.path, p.preload, p.run, std::string(to_string(p.phase)),
                          fmt::format("{}", p.n_rows), exact(1 / p.period), channel.name,
                          channel.unit, exact(s.min), exact(s.max), exact(s.quantum),
                          exact(s.noise), exact(s.at_limits),
                          fmt::format("{}", fmt::join(part.identifies, " "))});
  }
}

}  // namespace

Document check_document(const CheckResult& result) {
  Document document;
  document.tidy = tidy_check_table();
  document.warnings = result.warnings;
  for (const CheckedLog& log : result.logs) {
    add_figures(document, log.figures);
    document.tables.push_back(parts_table(log));
    document.tables.push_back(channels_table(log));
    for (const CheckedPart& part : log.parts) {
      add_tidy_rows(document.tidy, log, part);
      const std::string where = log.path + ", " + part_name(part) + ": ";
      if (!part.delay.reason.empty()) document.paragraphs.push_back(where + part.delay.reason);
      for (const std::string& warning : part.warnings) document.warnings.push_back(where + warning);
    }
  }
  return document;
}

}  // namespace cablefit
