#include "cablefit/report/documents/compare_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

constexpr int kPercentDigits = 2;
constexpr int kSdDigits = 2;

/// "viscous friction of the link", or nothing for a coefficient whose name says it.
std::string meaning_of(const std::string& name) {
  const ParameterInfo* info = effect_parameter(name);
  return info != nullptr ? std::string(info->meaning) : "";
}

/// Whether names alone would be ambiguous.
bool has_several(const CompareResult& result, std::string ComparedParameter::*text) {
  const auto& all = result.parameters;
  return std::any_of(all.begin(), all.end(),
                     [&](const ComparedParameter& p) { return p.*text != all.front().*text; });
}

/// "low: " where there are several.
std::string preload_of(const CompareResult& result, const ComparedParameter& p) {
  const bool several = has_several(result, &ComparedParameter::preload) && !p.preload.empty();
  return several ? p.preload + ": " : "";
}

std::string place_of(const CompareResult& result, const ComparedParameter& p) {
  std::string place;
  if (has_several(result, &ComparedParameter::preload) && !p.preload.empty()) place = p.preload;
  if (has_several(result, &ComparedParameter::stage))
    place += (place.empty() ? "" : ", ") + p.stage;
  return place.empty() ? p.name : fmt::format("{} ({})", p.name, place);
}

std::string names_of(const CompareResult& result, Sameness sameness) {
  std::vector<std::string> names;
  for (const ComparedParameter& p : result.parameters)
    if (p.sameness == sameness) names.push_back(place_of(result, p));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string margin_text(const CompareResult& result) {
  return fmt::format("{:.4g} %", 100 * result.options.margin);
}

std::string verdict_text(const ComparedParameter& p) {
  if (p.sameness == Sameness::undecided && std::isfinite(p.more_data))
    return fmt::format("undecided: {} times the data", significant(std::max(1.1, p.more_data), 2));
  if (p.sameness == Sameness::different && p.is_within_margin)
    return "different, within the margin";
  return std::string(to_string(p.sameness));
}

std::vector<std::string> notes_of(const CompareResult& result) {
  const std::string margin = margin_text(result);
  std::vector<std::string> notes = {
      fmt::format("different: p < {1} among all {0} (t test of every difference, Sidak); equal: "
                  "within {2} by two one-sided tests; undecided: neither; with N times the data, "
                  "equal parameters would show as equal",
                  result.parameters.size(), result.options.significance, margin)};
  if (std::any_of(result.parameters.begin(), result.parameters.end(),
                  [](const ComparedParameter& p) { return !p.is_relative; }))
    notes.push_back(fmt::format(
        "margin of an offset: {} of the rms torque, of an encoder's zero: {} of half the range of "
        "deflections",
        margin, margin));
  return notes;
}

/// ", poly", when it is one and has a name.
std::string model_text(const CompareResult& result) {
  const std::string& model = result.parameters.front().model;
  const bool one = !model.empty() && !has_several(result, &ComparedParameter::model);
  return one ? ", " + model : "";
}

Table table_of(const CompareResult& result) {
  Table table;
  table.title =
      fmt::format("{} (A) and {} (B){}", result.first.path, result.second.path, model_text(result));
  table.columns = {{"", "preload", "", true},
                   {"", "parameter", "", true},
                   {"", "unit", "", true},
                   {"A", "value", ""},
                   {"A", "sd", ""},
                   {"B", "value", ""},
                   {"B", "sd", ""},
                   {"B - A", "", "%"},
                   {"B - A", "in sd", ""},
                   {"", "p", ""},
                   {"", "verdict", "", true, true}};
  const bool several = has_several(result, &ComparedParameter::preload);
  if (!several) table.columns.erase(table.columns.begin());
  for (const ComparedParameter& p : result.parameters) {
    table.rows.push_back({p.preload, p.name, p.unit, value_text(p.first, p.first_sd),
                          sd_text(p.first, p.first_sd), value_text(p.second, p.second_sd),
                          sd_text(p.second, p.second_sd), significant(p.percent(), kPercentDigits),
                          p.sd > 0 ? significant(p.difference / p.sd, kSdDigits) : kNoNumber,
                          p.sd > 0 ? significant(p.p_together, kSdDigits) : kNoNumber,
                          verdict_text(p)});
    if (!several) table.rows.back().erase(table.rows.back().begin());
  }
  table.notes = notes_of(result);
  return table;
}

std::string conclusion(const CompareResult& result) {
  const std::size_t different = result.count(Sameness::different);
  const std::size_t undecided = result.count(Sameness::undecided);
  const std::size_t n = result.parameters.size();
  if (different > 0) return fmt::format("{} of {} parameters differ", different, n);
  if (undecided > 0)
    return fmt::format("no difference found in {} parameters, but {} could hide one beyond {}", n,
                       undecided, margin_text(result));
  const bool same = std::all_of(result.parameters.begin(), result.parameters.end(),
                                [](const ComparedParameter& p) { return p.difference == 0; });
  if (same) return fmt::format("all {} parameters are the same in every digit", n);
  return fmt::format("all {} parameters are equal within {}", n, margin_text(result));
}

Headline headline_of(const CompareResult& result) {
  const std::size_t different = result.count(Sameness::different);
  const std::size_t undecided = result.count(Sameness::undecided);
  const std::size_t equal = result.count(Sameness::equal);
  Headline headline;
  headline.word = different > 0 ? "different" : undecided > 0 ? "undecided" : "equal";
  headline.tone = tone_of(headline.word);
  headline.verdict = conclusion(result);
  for (const auto& [label, n] : {std::pair("different", different),
                                 std::pair("undecided", undecided), std::pair("equal", equal)})
    headline.numbers.push_back({label, fmt::format("{} of {}", n, result.parameters.size())});
  return headline;
}

/// Differences in the unit of sd of the difference, side by side whatever their units.
Figure difference_figure(const CompareResult& result) {
  Figure figure;
  figure.title = "Difference B - A, in per cent of A";
  figure.caption =
      "Bars: intervals that hold for all parameters together. An interval without "
      "zero is a difference.";
  figure.x = {"parameter", ""};
  figure.y = {"difference", "%"};
  figure.wide = true;
  Trace trace{"B - A", TraceStyle::interval, 1, {}, {}, {}, {}, {}};
  for (const ComparedParameter& p : result.parameters) {
    if (!std::isfinite(p.percent())) continue;
    const double to_percent = 100 / std::abs(p.first);
    trace.labels.push_back(place_of(result, p));
    trace.y.push_back(p.percent());
    trace.low.push_back(to_percent * p.low);
    trace.high.push_back(to_percent * p.high);
  }
  figure.traces = {trace};
  return figure;
}

Table tidy_of(const CompareResult& result) {
  Table table;
  for (const char* name :
       {"preload", "stage", "model", "parameter", "unit", "first", "first_sd", "second",
        "second_sd", "difference", "sd", "low", "high", "p_together", "margin", "verdict"})
    table.columns.push_back({"", name, "", true});
  for (const ComparedParameter& p : result.parameters)
    table.rows.push_back(
        {p.preload, p.stage, p.model, p.name, p.unit, exact(p.first), exact(p.first_sd),
         exact(p.second), exact(p.second_sd), exact(p.difference), exact(p.sd), exact(p.low),
         exact(p.high), exact(p.p_together), exact(p.margin), std::string(to_string(p.sameness))});
  return table;
}

}  // namespace

std::string change_text(const ComparedParameter& p) {
  const std::string meaning = meaning_of(p.name);
  std::string text = p.name;
  if (!meaning.empty()) text += fmt::format(" ({})", meaning);
  const char* way = p.difference > 0 ? "up" : "down";
  text += std::isfinite(p.percent())
              ? fmt::format(": {} {} %", way, significant(std::abs(p.percent()), kPercentDigits))
              : fmt::format(": {} {} {}", way, significant(std::abs(p.difference), 3), p.unit);
  text += fmt::format(", {} -> {} {}", value_text(p.first, p.first_sd),
                      value_text(p.second, p.second_sd), p.unit);
  if (p.sd > 0)
    text += fmt::format(", {} sd", significant(std::abs(p.difference) / p.sd, kSdDigits));
  return text;
}

Document compare_document(const CompareResult& result) {
  Document document;
  document.title = "Comparison";
  document.summary.push_back({"verdict", conclusion(result)});
  for (const ComparedParameter& p : result.parameters)
    if (p.sameness == Sameness::different)
      document.summary.push_back({p.is_within_margin ? "changed a little" : "changed",
                                  fmt::format("{}{}", preload_of(result, p), change_text(p))});
  if (result.count(Sameness::equal) > 0)
    document.summary.push_back(
        {fmt::format("equal within {}", margin_text(result)), names_of(result, Sameness::equal)});
  if (result.count(Sameness::undecided) > 0)
    document.summary.push_back({"undecided", names_of(result, Sameness::undecided)});
  for (const std::string& setting : result.settings)
    document.summary.push_back({"not the same", setting});
  document.tables.push_back(table_of(result));
  for (const Uncompared& one : result.not_compared)
    document.paragraphs.push_back(fmt::format("Not compared: {}{}{}: {}", one.preload,
                                              one.preload.empty() ? "" : ", ", one.name,
                                              one.reason));
  document.warnings = result.warnings;
  document.figures = {difference_figure(result)};
  document.headline = headline_of(result);
  lead_with(document, 1);
  document.tidy = tidy_of(result);
  return document;
}

}  // namespace cablefit
