#include "cablefit/report/documents/simulate_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/parts/part_names.hpp"

namespace cablefit {
namespace {

constexpr int kGapDigits = 3;
constexpr int kShareDigits = 3;

Table band_table(const SimulateResult& result) {
  Table table;
  table.title = "Uncertainty from the parameters";
  table.columns = {{"", "log", "", true},
                   {"", "signal", "", true},
                   {"", "unit", "", true},
                   {"95 % band", "half width", ""},
                   {"rows", "within", "%"}};
  for (const SimulatedPart& part : result.parts)
    for (const SignalGap& gap : part.gaps) {
      if (!gap.band) continue;
      const auto [factor, unit] = shown_unit(gap.unit);
      const bool first = &gap == &part.gaps.front();
      table.rows.push_back({first ? cell_name(result.parts, part) : "", gap.signal, unit,
                            significant(factor * gap.band->half_width, 2),
                            significant(100 * gap.band->inside, kShareDigits)});
    }
  table.notes = {
      "95 % band: from the joint covariance of the parameters, rms over the rows; within: rows "
      "with "
      "a gap inside band and sensor noise together"};
  return table;
}

Table gap_table(const SimulateResult& result) {
  Table table;
  table.title = "Gap: simulated minus measured";
  table.columns = {{"", "log", "", true},  {"", "mode", "", true}, {"", "signal", "", true},
                   {"", "unit", "", true}, {"", "rms", ""},        {"largest", "gap", ""},
                   {"largest", "at", "s"}, {"", "relative", "%"},  {"", "sensor noise", ""}};
  bool replayed = false;
  for (const SimulatedPart& part : result.parts) {
    replayed = replayed || !part.closed_loop;
    for (const SignalGap& gap : part.gaps) {
      const bool first = &gap == &part.gaps.front();
      const auto [factor, unit] = shown_unit(gap.unit);
      table.rows.push_back(
          {first ? cell_name(result.parts, part) : "", first ? std::string(part.mode()) : "",
           gap.signal, unit, significant(factor * gap.rms, kGapDigits),
           significant(factor * gap.max_abs, kGapDigits), significant(gap.t_of_max, kTimeDigits),
           significant(100 * gap.relative, kGapDigits), significant(factor * gap.noise, 2)});
    }
  }
  table.notes = {
      "relative: rms gap / rms of the measured signal about its mean; sensor noise: sd, rounding "
      "included: the gap of a perfect model in closed loop"};
  if (replayed) {
    table.notes.emplace_back(
        "torque replay: the noise of the replayed torque adds to the gap of the positions, growing "
        "from the start of each window");
  }
  return table;
}

Table part_table(const SimulateResult& result) {
  Table table;
  table.title = "Simulated";
  table.columns = {{"", "log", "", true},     {"", "preload", "", true}, {"", "phase", "", true},
                   {"", "window", "s"},       {"", "starts", ""},        {"rows", "simulated", ""},
                   {"rows", "resampled", ""}, {"rows", "too short", ""}, {"", "all taut", "%"}};
  for (const SimulatedPart& part : result.parts) {
    table.rows.push_back(
        {cell_name(result.parts, part), part.preload, part.phase,
         part.window_seconds > 0 ? significant(part.window_seconds, kGapDigits) : kNoNumber,
         std::to_string(part.n_windows), std::to_string(part.n_rows),
         std::to_string(part.counts.rows_resampled), std::to_string(part.counts.rows_too_short),
         part.closure_share ? significant(100 * *part.closure_share, kShareDigits) : kNoNumber});
  }
  return table;
}

Table cable_table(const SimulateResult& result) {
  Table table;
  table.title = "Cables in the simulation";
  table.columns = {{"", "log", "", true},   {"", "cable", "", true}, {"", "unit", "", true},
                   {"tension", "from", ""}, {"tension", "to", ""},   {"", "slack", "%"}};
  table.detail = true;
  for (const SimulatedPart& part : result.parts) {
    for (const CableTension& cable : part.cables) {
      table.rows.push_back({cell_name(result.parts, part), cable.cable, cable.unit,
                            significant(cable.min, kGapDigits), significant(cable.max, kGapDigits),
                            significant(100 * cable.slack_share, kShareDigits)});
    }
  }
  return table;
}

Table tidy_gaps(const SimulateResult& result) {
  Table table;
  for (const char* name :
       {"log", "preload", "phase", "run", "model", "mode", "window", "rows", "signal", "unit",
        "rms", "max_abs", "t_of_max", "relative", "noise", "worst_window_t", "worst_window_rms",
        "band95_half_width", "band95_inside"}) {
    table.columns.push_back({"", name, ""});
  }
  for (const SimulatedPart& part : result.parts) {
    for (const SignalGap& gap : part.gaps) {
      table.rows.push_back(
          {part.log, part.preload, part.phase, part.run, result.model_name,
           std::string(part.mode()), exact(part.window_seconds), std::to_string(part.n_rows),
           gap.signal, gap.unit, exact(gap.rms), exact(gap.max_abs), exact(gap.t_of_max),
           exact(gap.relative), exact(gap.noise), exact(gap.t_of_worst_window),
           exact(gap.worst_window_rms), gap.band ? exact(gap.band->half_width) : "",
           gap.band ? exact(gap.band->inside) : ""});
    }
  }
  return table;
}

/// Of every signal the largest gap among the parts.
Headline headline_of(const SimulateResult& result) {
  constexpr std::size_t kMostNumbers = 3;
  Headline headline;
  std::vector<SignalGap> worst;
  for (const SimulatedPart& part : result.parts) {
    if (!part.diverged.empty()) headline = {"diverged", Tone::bad, part.diverged, {}};
    for (const SignalGap& gap : part.gaps) {
      const auto same = std::find_if(worst.begin(), worst.end(), [&](const SignalGap& other) {
        return other.signal == gap.signal;
      });
      if (same == worst.end())
        worst.push_back(gap);
      else if (gap.rms > same->rms)
        *same = gap;
    }
  }
  if (worst.size() > kMostNumbers) worst.resize(kMostNumbers);
  for (const SignalGap& gap : worst) {
    const auto [factor, unit] = shown_unit(gap.unit);
    headline.numbers.push_back(
        {fmt::format("gap of {}{}, rms", gap.signal, result.parts.size() > 1 ? ", largest" : ""),
         fmt::format("{} {}", significant(factor * gap.rms, kGapDigits), unit)});
  }
  if (headline.verdict.empty())
    headline.verdict = fmt::format("{} part{} simulated with the model {}", result.parts.size(),
                                   result.parts.size() == 1 ? "" : "s", result.model_name);
  return headline;
}

}  // namespace

Document simulate_document(const SimulateResult& result) {
  Document document;
  document.title = "Simulation of the model on the input of the logs";
  const bool says_path = result.model_choice.find(result.model_path) != std::string::npos;
  document.summary.push_back(
      {"used", says_path ? result.model_choice
                         : fmt::format("{}, from {}", result.model_choice, result.model_path)});
  add_table(document, gap_table(result));
  add_table(document, band_table(result));
  add_table(document, cable_table(result));
  add_detail(document, part_table(result));
  document.tidy = tidy_gaps(result);
  if (!result.trajectories.empty())
    document.summary.push_back({"trajectories", result.trajectories});
  add_warnings(document, "", result.warnings);
  add_parts(document, result.parts,
            [&](const SimulatedPart& part) { return part_name(result.parts, part); });
  document.headline = headline_of(result);
  lead_with(document, 1);
  return document;
}

}  // namespace cablefit
