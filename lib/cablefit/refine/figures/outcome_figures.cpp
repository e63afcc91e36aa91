#include "cablefit/refine/figures/outcome_figures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "cablefit/figure/new_trace.hpp"

namespace cablefit {
namespace {

std::string effect_name(const Rival& rival) {
  return fmt::format("{} ({})", rival.name, rival.side);
}

Figure ranking_figure(const RefineResult& result) {
  constexpr std::size_t kMostBars = 10;
  constexpr double kVisible = 0.005;  // of the gap: less is printed as 0 %
  Figure figure;
  figure.section = "Outcome";
  figure.title = "Candidates for the first effect";
  figure.caption =
      "Share of the squared gap above the noise floor that each would remove on "
      "held-out blocks, with all other parameters fitted again.";
  figure.x = {"effect", ""};
  figure.y = {"removed", "%"};
  figure.wide = true;
  Trace bars = new_trace("candidates", TraceStyle::interval, kBefore);
  for (const Rival& row : result.ranking) {
    if (!row.refused.empty() || bars.y.size() == kMostBars) break;
    if (row.gain < kVisible) continue;
    bars.labels.push_back(effect_name(row));
    bars.y.push_back(100 * row.gain);
    bars.low.push_back(0);
    bars.high.push_back(100 * row.gain);
  }
  if (!bars.y.empty()) figure.traces.push_back(std::move(bars));
  return figure;
}

Figure shift_figure(const RefineResult& result) {
  Figure figure;
  figure.section = "Outcome";
  figure.title = "How far the parameters moved";
  figure.caption =
      "After minus before, in sd; bars: 95 %. A missing effect biases other "
      "parameters; adding it removes this bias.";
  figure.x = {"parameter", ""};
  figure.y = {"shift", "sd"};
  constexpr double k95 = 1.96;
  Trace trace = new_trace("shift", TraceStyle::interval, kAfter);
  for (const ParameterShift& shift : result.shifts) {
    const double moved = (shift.after - shift.before) / shift.sd;
    if (!std::isfinite(moved)) continue;
    trace.labels.push_back(shift.name);
    trace.y.push_back(moved);
    trace.low.push_back(moved - k95);
    trace.high.push_back(moved + k95);
  }
  if (!trace.y.empty() && !result.effects.empty()) figure.traces.push_back(std::move(trace));
  return figure;
}

}  // namespace

std::vector<Figure> outcome_figures(const RefineResult& result) {
  std::vector<Figure> figures;
  for (Figure figure : {ranking_figure(result), shift_figure(result)})
    if (!figure.traces.empty()) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace cablefit
