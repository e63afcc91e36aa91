#include "cablefit/report/documents/check_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// How a part is called within its log.
std::string part_name(const CheckedPart& part) {
  const PartSurvey& s = part.survey;
  return s.run.empty() ? s.preload : s.preload + ", run " + s.run;
}

/// A printed time is rounded: less than 0.001 % of jitter is none.
std::string fine_percent(double share) { return share < 1e-5 ? "0" : significant(100 * share, 2); }

std::string good_for(const CheckedPart& part) {
  return part.identifies.empty() ? "nothing" : fmt::format("{}", fmt::join(part.identifies, ", "));
}

/// All logs in short.
Table logs_table(const CheckResult& result) {
  Table table;
  const Axes axes = axes_of(result.logs);
  table.columns = {{"", "log", "", true},     {"", "part", "", true},
                   {"", "phase", "", true},   {"", "duration", "s"},
                   {"", "rate", "Hz"},        {"", "gaps", ""},
                   {"", "at rest", "%"},      {"", "fastest", unit_for(axes, "rad/s")},
                   {"", "good for", "", true}};
  for (const CheckedLog& log : result.logs)
    for (const CheckedPart& part : log.parts) {
      const PartSurvey& s = part.survey;
      const bool known = !part.excitation.channel.empty();
      table.rows.push_back({log.path, part_name(part), std::string(to_string(s.phase)),
                            significant(s.t_last - s.t_first, kFineDigits),
                            significant(1 / s.period, kFineDigits), fmt::format("{}", s.n_gaps),
                            known ? fine_percent(part.excitation.share_at_rest) : kNoNumber,
                            known ? significant(part.excitation.fastest, 3) : kNoNumber,
                            good_for(part)});
    }
  return table;
}

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
                   {"motion", "fastest", unit_for(log.axes, "rad/s")},
                   {"motion", "speeds", "of 10"},
                   {"", "good for", "", true}};
  for (const CheckedPart& part : log.parts) {
    const PartSurvey& s = part.survey;
    const CheckedExcitation& e = part.excitation;
    const bool known = !e.channel.empty();
    table.rows.push_back(
        {part_name(part), std::string(to_string(s.phase)), fmt::format("{}", s.n_rows),
         significant(s.t_last - s.t_first, kFineDigits), significant(1 / s.period, kFineDigits),
         fine_percent(s.jitter), fine_percent(s.worst_jitter), fmt::format("{}", s.n_gaps),
         known ? fine_percent(e.share_at_rest) : kNoNumber,
         known ? significant(e.fastest, 3) : kNoNumber,
         known ? fmt::format("{}", e.speed_bands) : kNoNumber, good_for(part)});
  }
  for (const Decision& decision : log.decisions)
    table.notes.push_back(
        fmt::format("{}: {} ({})", decision.name, decision.value, decision.reason));
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
                            significant(s.min, kFineDigits), significant(s.max, kFineDigits),
                            channel.is_angle ? significant(kDegrees * s.range(), 3) : kNoNumber,
                            significant(s.quantum, 2), significant(s.noise, 2),
                            fine_percent(s.at_limits)});
    }
  }
  return table;
}

Table tidy_check_table() {
  Table table;
  for (const char* name : {"log",
                           "preload",
                           "run",
                           "phase",
                           "rows",
                           "rate",
                           "channel",
                           "unit",
                           "min",
                           "max",
                           "quantum",
                           "noise",
                           "share_at_limits",
                           "good_for",
                           "equation",
                           "parameter",
                           "sd_at_best",
                           "size_first_look",
                           "sd_first_look",
                           "closest",
                           "correlation",
                           "verdict"}) {
    table.columns.push_back({"", name, ""});
  }
  return table;
}

/// A row per predicted parameter, of all the logs that stage 2 would fit together.
void add_tidy_rows(Table& table, const Prediction& p) {
  for (const PredictedEquation& e : p.equations)
    for (const PredictedParameter& parameter : e.parameters)
      table.rows.push_back({fmt::format("{}", fmt::join(p.logs, " ")),
                            p.preload,
                            "",
                            "moving",
                            fmt::format("{}", e.rows),
                            "",
                            "",
                            parameter.unit,
                            "",
                            "",
                            "",
                            "",
                            "",
                            "",
                            e.name,
                            parameter.name,
                            exact(parameter.sd_best),
                            exact(parameter.size),
                            exact(parameter.sd_first_look),
                            parameter.closest,
                            parameter.closest.empty() ? "" : exact(parameter.correlation),
                            std::string(to_string(parameter.determined))});
}

void add_tidy_rows(Table& table, const CheckedLog& log, const CheckedPart& part) {
  const PartSurvey& p = part.survey;
  for (const CheckedChannel& channel : part.channels) {
    const ChannelSurvey& s = channel.survey;
    table.rows.push_back({log.path,
                          p.preload,
                          p.run,
                          std::string(to_string(p.phase)),
                          fmt::format("{}", p.n_rows),
                          exact(1 / p.period),
                          channel.name,
                          channel.unit,
                          exact(s.min),
                          exact(s.max),
                          exact(s.quantum),
                          exact(s.noise),
                          exact(s.at_limits),
                          fmt::format("{}", fmt::join(part.identifies, " ")),
                          "",
                          "",
                          "",
                          "",
                          "",
                          "",
                          "",
                          ""});
  }
}

/// "0.3": a size of which one digit may be right.
std::string size_text(const PredictedParameter& p) {
  return p.determined == Determined::given ? significant(p.size, kFineDigits)
                                           : significant(p.size, 1);
}

std::string sd_number(double sd) {
  return std::isfinite(sd) && sd > 0 ? significant(sd, 2) : kNoNumber;
}

std::string closest_text(const PredictedParameter& p) {
  return p.closest.empty() ? kNoNumber : fmt::format("{} {:.2f}", p.closest, p.correlation);
}

/// What a row of the table says of the prediction that it stands under.
std::string about(const Prediction& p, const PredictedEquation& e) {
  const std::string torque = torque_unit(p.axes);
  return fmt::format(
      "{}: {} samples, scaled condition number {}, sensor noise {} {}, residual of the preliminary "
      "fit {} {}",
      e.name, e.rows,
      std::isfinite(e.condition_scaled) ? significant(e.condition_scaled, 2) : "infinite",
      significant(e.noise, 2), torque, significant(e.left, 2), torque);
}

Table prediction_table(const Prediction& p) {
  Table table;
  table.title = fmt::format("{}: what stage 2 will determine of the {} drive (predicted)",
                            p.preload, p.rigid ? "rigid" : "elastic");
  table.columns = {{"", "equation", "", true},      {"", "parameter", "", true},
                   {"", "unit", "", true},          {"lower bound", "sd", ""},
                   {"preliminary fit", "size", ""}, {"preliminary fit", "sd", ""},
                   {"preliminary fit", "sd", "%"},  {"", "closest", "", true},
                   {"", "verdict", "", true, true}};
  for (const PredictedEquation& e : p.equations) {
    for (const PredictedParameter& parameter : e.parameters)
      table.rows.push_back({e.name, parameter.name, parameter.unit, sd_number(parameter.sd_best),
                            size_text(parameter), sd_number(parameter.sd_first_look),
                            sd_number(100 * parameter.relative_sd()), closest_text(parameter),
                            std::string(to_string(parameter.determined))});
    table.notes.push_back(about(p, e));
  }
  return table;
}

/// "f_v" and "2" of "f_v[2]"; no joint: of all, as the base parameters of an arm.
struct JointParameter {
  std::string name, joint;
};

JointParameter split(const std::string& name) {
  const std::size_t open = name.rfind('[');
  if (open == std::string::npos || !name.ends_with(']')) return {name, ""};
  return {name.substr(0, open), name.substr(open + 1, name.size() - open - 2)};
}

std::size_t place_in(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

std::string short_verdict(Determined determined) {
  return determined == Determined::identifiable       ? "well"
         : determined == Determined::not_identifiable ? "no"
                                                      : std::string(to_string(determined));
}

struct NamedVerdict {
  std::string row, parameter, verdict;
};

/// A row per joint or preload (`what`), a column per parameter; of one alone no row.
Table verdict_matrix(const std::string& what, const std::vector<NamedVerdict>& all) {
  Table table;
  std::vector<std::string> rows, names;
  std::map<std::pair<std::size_t, std::size_t>, std::string> verdicts;
  for (const NamedVerdict& one : all) {
    const std::size_t row = place_in(rows, one.row), name = place_in(names, one.parameter);
    verdicts[{row, name}] = one.verdict;
  }
  if (rows.size() < 2) return table;
  table.columns = {{"", what, "", true}};
  for (const std::string& name : names) table.columns.push_back({"", name, "", true});
  for (std::size_t j = 0; j < rows.size(); ++j) {
    std::vector<std::string>& row = table.rows.emplace_back(1, rows[j]);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto found = verdicts.find({j, k});
      row.push_back(found != verdicts.end() ? found->second : kNoNumber);
    }
  }
  return table;
}

template <typename Add>
void for_each_parameter(const Prediction& p, Add add) {
  for (const PredictedEquation& e : p.equations)
    for (const PredictedParameter& parameter : e.parameters) add(parameter);
}

Table joint_matrix(const Prediction& p) {
  std::vector<NamedVerdict> all;
  for_each_parameter(p, [&](const PredictedParameter& parameter) {
    const JointParameter own = split(parameter.name);
    if (!own.joint.empty())
      all.push_back({own.joint, own.name, short_verdict(parameter.determined)});
  });
  Table table = verdict_matrix("joint", all);
  table.title = fmt::format("{}: what stage 2 will determine of each joint (predicted)", p.preload);
  return table;
}

/// Of drives of one joint: those of several have a matrix each.
Table preload_matrix(const std::vector<Prediction>& predictions) {
  std::vector<NamedVerdict> all;
  for (const Prediction& p : predictions)
    for_each_parameter(p, [&](const PredictedParameter& parameter) {
      if (split(parameter.name).joint.empty())
        all.push_back({p.preload, parameter.name, short_verdict(parameter.determined)});
    });
  Table table = verdict_matrix("preload", all);
  table.title = "What stage 2 will determine of each preload (predicted)";
  return table;
}

void add_prediction(const Prediction& p, bool is_in_matrix, Document& document) {
  if (!p.none.empty()) {
    document.paragraphs.push_back(p.preload + ": no prediction of stage 2: " + p.none);
    return;
  }
  Table joints = joint_matrix(p), parameters = prediction_table(p);
  parameters.detail = is_in_matrix || !joints.rows.empty();
  if (!joints.rows.empty()) document.tables.push_back(std::move(joints));
  document.tables.push_back(std::move(parameters));
  for (const PredictedEquation& e : p.equations)
    for (const std::string& sentence : e.sentences)
      document.warnings.push_back(fmt::format("{}, {}: {}", p.preload, e.name, sentence));
}

/// How much there is, and what it is good for.
Headline headline_of(const CheckResult& result, const std::vector<Prediction>& predictions) {
  std::size_t n_parts = 0, n_useful = 0, n_parameters = 0, n_weak = 0;
  double seconds = 0;
  for (const CheckedLog& log : result.logs)
    for (const CheckedPart& part : log.parts) {
      ++n_parts;
      n_useful += part.identifies.empty() ? 0 : 1;
      seconds += part.survey.t_last - part.survey.t_first;
    }
  for (const Prediction& p : predictions)
    for (const PredictedEquation& e : p.equations)
      for (const PredictedParameter& parameter : e.parameters) {
        ++n_parameters;
        n_weak += parameter.determined == Determined::weak ||
                          parameter.determined == Determined::not_identifiable
                      ? 1
                      : 0;
      }
  Headline headline;
  const bool is_good = n_useful == n_parts && n_weak == 0;
  headline.word = n_useful == 0 ? "not usable" : is_good ? "usable" : "partly usable";
  headline.tone = n_useful == 0 ? Tone::bad : is_good ? Tone::good : Tone::neutral;
  headline.verdict = fmt::format("{} of {} parts of the logs can be fitted", n_useful, n_parts);
  headline.numbers = {{"logs", fmt::format("{}", result.logs.size())},
                      {"recorded", significant(seconds, 3) + " s"}};
  if (n_parameters > 0)
    headline.numbers.push_back({"parameters that stage 2 will determine well",
                                fmt::format("{} of {}", n_parameters - n_weak, n_parameters)});
  return headline;
}

constexpr const char* kHowPredicted =
    "lower bound: white sensor noise alone (Cramer-Rao); preliminary fit: a rough model of these "
    "logs alone, one digit of each size, with the robust sd of its residual; stage 1 makes the "
    "model better and adds its own error; closest: the parameter with the strongest correlation";

}  // namespace

Document check_document(const CheckResult& result, const std::vector<Prediction>& predictions) {
  Document document;
  document.title = "Content of the logs";
  document.tidy = tidy_check_table();
  add_table(document, logs_table(result));
  document.warnings = result.warnings;
  for (const CheckedLog& log : result.logs) {
    add_figures(document, log.figures);
    add_detail(document, parts_table(log));
    add_detail(document, channels_table(log));
    for (const CheckedPart& part : log.parts) {
      add_tidy_rows(document.tidy, log, part);
      const std::string where = log.path + ", " + part_name(part) + ": ";
      if (!part.delay.reason.empty()) document.paragraphs.push_back(where + part.delay.reason);
      for (const std::string& warning : part.warnings) document.warnings.push_back(where + warning);
    }
  }
  Table preloads = preload_matrix(predictions);
  const bool has_matrix = !preloads.rows.empty();
  if (has_matrix) document.tables.push_back(std::move(preloads));
  for (const Prediction& p : predictions) {
    add_prediction(p, has_matrix, document);
    add_tidy_rows(document.tidy, p);
  }
  const bool any = std::any_of(predictions.begin(), predictions.end(),
                               [](const Prediction& p) { return p.none.empty(); });
  if (any) document.tables.back().notes.emplace_back(kHowPredicted);
  document.headline = headline_of(result, predictions);
  lead_with(document, 1);
  return document;
}

}  // namespace cablefit
