#include "cablefit/report/documents/predict_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/parts/part_names.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostContacts = 5;  // of a joint, on the screen

Table signal_table(const PredictResult& result) {
  Table table;
  table.title = "Elastic quantities";
  table.columns = {{"", "log", "", true},  {"", "quantity", "", true},
                   {"", "unit", "", true}, {"", "least", ""},
                   {"", "largest", ""},    {"95 % band", "half width", ""}};
  for (const PredictedPart& part : result.parts)
    for (const PredictedSignal& signal : part.signals) {
      const auto [factor, unit] = shown_unit(signal.unit);
      const bool first = &signal == &part.signals.front();
      table.rows.push_back({first ? cell_name(result.parts, part) : "", signal.name, unit,
                            significant(factor * signal.least, kDigits),
                            significant(factor * signal.largest, kDigits),
                            signal.half_width ? significant(factor * *signal.half_width, 2)
                                              : std::string(kNoNumber)});
    }
  table.notes = {
      "95 % band: from the joint covariance of the elastic parameters, rms over the rows"};
  return table;
}

Table torque_table(const PredictResult& result) {
  Table table;
  table.title = "Predicted and measured torque";
  table.columns = {{"", "log", "", true},    {"", "torque", "", true}, {"", "unit", "", true},
                   {"", "by", "", true},     {"", "rows", ""},         {"error", "rms", ""},
                   {"error", "largest", ""}, {"error", "at", "s"},     {"", "relative", "%"}};
  bool is_any_alone = false;
  for (const PredictedPart& part : result.parts)
    for (const SensedTorque& torque : part.torques) {
      is_any_alone = is_any_alone || !torque.is_measured;
      const bool first = &torque == &part.torques.front();
      table.rows.push_back({first ? cell_name(result.parts, part) : "",
                            torque.signal + (torque.is_measured ? "" : " *"), torque.unit,
                            torque.method, std::to_string(torque.n_rows),
                            significant(torque.rms, kDigits), significant(torque.max_abs, kDigits),
                            significant(torque.t_of_max, kTimeDigits),
                            significant(100 * torque.relative, kDigits)});
    }
  if (is_any_alone)
    table.notes.emplace_back("*: not measured; the numbers are of the torque itself");
  return table;
}

Table watch_table(const PredictResult& result) {
  Table table;
  table.title = "Contact detection";
  table.columns = {{"", "log", "", true},
                   {"", "joint", "", true},
                   {"torque", "threshold", torque_unit(result.axes)},
                   {"torque", "detected", torque_unit(result.axes)},
                   {"windows", "monitored", ""},
                   {"windows", "alarms", ""},
                   {"windows", "expected", ""},
                   {"without contact", "windows", ""},
                   {"without contact", "alarms", ""},
                   {"", "not monitored", "s"}};
  for (const PredictedPart& part : result.parts)
    for (const ContactWatch& watch : part.watches)
      table.rows.push_back(
          {cell_name(result.parts, part), watch.joint,
           significant(watch.detector.threshold, kDigits),
           significant(watch.detector.torque, kDigits), std::to_string(watch.n_windows),
           std::to_string(watch.n_alarms), significant(watch.expected_alarms, 2),
           watch.quiet_windows ? std::to_string(*watch.quiet_windows) : std::string(kNoNumber),
           watch.false_alarms ? std::to_string(*watch.false_alarms) : std::string(kNoNumber),
           significant(watch.seconds_not_watched, kDigits)});
  table.notes = {
      "detected: smallest contact torque that is found; expected: alarms without any contact; "
      "not monitored: the link stands still, and dry friction hides the torque"};
  return table;
}

Table contact_table(const PredictResult& result) {
  Table table;
  table.title = "Contacts, by time";
  table.columns = {{"", "log", "", true},
                   {"", "joint", "", true},
                   {"", "from", "s"},
                   {"", "to", "s"},
                   {"", "torque", torque_unit(result.axes)}};
  for (const PredictedPart& part : result.parts)
    for (const ContactWatch& watch : part.watches) {
      const std::size_t n = std::min(watch.contacts.size(), kMostContacts);
      for (std::size_t k = 0; k < n; ++k)
        table.rows.push_back({cell_name(result.parts, part), watch.joint,
                              significant(watch.contacts[k].from, kTimeDigits),
                              significant(watch.contacts[k].to, kTimeDigits),
                              significant(watch.contacts[k].torque, kDigits)});
      if (n < watch.contacts.size())
        table.notes.push_back(fmt::format("{}, joint {}: {} more in the JSON result",
                                          cell_name(result.parts, part), watch.joint,
                                          watch.contacts.size() - n));
    }
  return table;
}

Table tidy_signals(const PredictResult& result) {
  Table table;
  for (const char* name : {"log", "preload", "phase", "run", "model", "quantity", "unit", "least",
                           "largest", "band95_half_width"})
    table.columns.push_back({"", name, ""});
  for (const PredictedPart& part : result.parts)
    for (const PredictedSignal& signal : part.signals)
      table.rows.push_back({part.log, part.preload, part.phase, part.run, result.model_name,
                            signal.name, signal.unit, exact(signal.least), exact(signal.largest),
                            signal.half_width ? exact(*signal.half_width) : ""});
  return table;
}

/// "1 in 240 windows of 0.05 s; 4.0 s at rest are not monitored"; empty: none was watched.
std::string contacts_text(const PredictResult& result) {
  std::size_t n_contacts = 0, n_windows = 0;
  double window = 0, at_rest = 0;
  for (const PredictedPart& part : result.parts)
    for (const ContactWatch& watch : part.watches) {
      n_contacts += watch.contacts.size();
      n_windows += watch.n_windows;
      window = watch.window;
      at_rest += watch.seconds_not_watched;
    }
  if (n_windows == 0) return "";
  return fmt::format("{} in {} windows of {:g} s; {} s at rest are not monitored",
                     n_contacts == 0 ? "none" : std::to_string(n_contacts), n_windows, window,
                     significant(at_rest, 2));
}

/// The elastic torque, the error beside a sensor, and contacts: the largest of all parts.
Headline headline_of(const PredictResult& result) {
  Headline headline;
  double torque = 0, relative = 0;
  std::size_t n_contacts = 0, n_watched = 0;
  std::string unit;
  for (const PredictedPart& part : result.parts) {
    if (!part.signals.empty()) {
      const PredictedSignal& link = part.signals.front();
      torque = std::max({torque, std::abs(link.least), std::abs(link.largest)});
      unit = link.unit;
    }
    for (const SensedTorque& t : part.torques)
      if (t.is_measured && t.relative > relative) relative = t.relative;
    for (const ContactWatch& watch : part.watches) {
      n_contacts += watch.contacts.size();
      n_watched += watch.n_windows;
    }
  }
  headline.numbers.push_back(
      {"largest elastic torque", fmt::format("{} {}", significant(torque, kDigits), unit)});
  if (relative > 0)
    headline.numbers.push_back(
        {"largest error against a sensor", significant(100 * relative, kDigits) + " %"});
  if (n_watched > 0)
    headline.numbers.push_back({"contacts of the link", std::to_string(n_contacts)});
  headline.verdict = n_watched == 0    ? "elastic torques predicted"
                     : n_contacts == 0 ? "no contact of the link"
                                       : fmt::format("{} contact{} of the link", n_contacts,
                                                     n_contacts == 1 ? "" : "s");
  return headline;
}

}  // namespace

Document predict_document(const PredictResult& result) {
  Document document;
  document.title = "Prediction of the model along the logs";
  const bool says_path = result.model_choice.find(result.model_path) != std::string::npos;
  document.summary.push_back(
      {"used", says_path ? result.model_choice
                         : fmt::format("{}, from {}", result.model_choice, result.model_path)});
  if (const std::string text = contacts_text(result); !text.empty())
    document.summary.push_back({"contacts", text});
  add_table(document, torque_table(result));
  add_table(document, contact_table(result));
  add_table(document, signal_table(result));
  add_detail(document, watch_table(result));
  document.tidy = tidy_signals(result);
  if (!result.trajectories.empty())
    document.summary.push_back({"trajectories", result.trajectories});
  if (!result.sensed.empty()) document.summary.push_back({"torques", result.sensed});
  add_warnings(document, "", result.warnings);
  add_parts(document, result.parts,
            [&](const PredictedPart& part) { return cell_name(result.parts, part); });
  document.headline = headline_of(result);
  lead_with(document, 1);
  return document;
}

}  // namespace cablefit
