#include "cablefit/report/sections/preload_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/sections/batch_figures.hpp"

namespace cablefit {
namespace {

Axes axes_of(const BatchResult& result) {
  for (const BatchCell& cell : result.cells)
    if (cell.dynamic) return cell.dynamic->preloads.front().axes;
  return Axes::rotary;
}

Table advice_table(const std::vector<PreloadAdvice>& advice, const AdviceDetector& detector,
                   Axes axes) {
  const std::string torque = torque_unit(axes), way = unit_for(axes, "mrad");
  Table table;
  table.title = "Model error and friction of each preload";
  table.columns = {{"", "cell", "", true},
                   {"", "deflection", way},
                   {"largest error", "linear", torque},
                   {"largest error", "of peak", "%"},
                   {"largest error", "choice", torque},
                   {"", "friction", torque},
                   {"", "all taut", way},
                   {"smallest collision", "linear", torque},
                   {"smallest collision", "choice", torque}};
  for (const PreloadAdvice& a : advice)
    table.rows.push_back(
        {a.cell, milli_range(a.deflection_low, a.deflection_high),
         significant(a.linear_error, kDigits), significant(100 * a.linear_share, kDigits),
         significant(a.model_error, kDigits), value_with_sd(a.friction, a.friction_sd),
         milli_range(a.closure_low, a.closure_high), significant(a.collision_linear, kDigits),
         significant(a.collision_model, kDigits)});
  table.notes = {
      "largest error: on the blocked samples, of the linear spring and of stage 1's choice; "
      "friction: f_s + f_sm; all taut: needs l_o in the rig file ('cablefit identify' finds it)",
      fmt::format("smallest collision: link torque that is detected above the model's largest "
                  "error and the residual of the link equation with a probability of {:.4g}; one "
                  "test every {:.4g} s, false alarms an hour: {:.4g}",
                  detector.detection_rate, detector.window, detector.false_alarms_per_hour)};
  return table;
}

Figure advice_figure(const std::vector<PreloadAdvice>& advice, Axes axes) {
  Figure figure;
  figure.section = "Preload trade-off";
  figure.title = "Model error and friction against preload";
  figure.caption =
      "Bars on the friction: 95 % intervals. A collision smaller than its mark is not separable "
      "from the model's own error.";
  figure.x = {kPreloadAxis, ""};
  figure.y = {"torque", torque_unit(axes)};
  figure.wide = true;
  struct Line {
    const char* name;
    double PreloadAdvice::*value;
  };
  int series = 1;
  for (const Line& line :
       {Line{"largest error of the linear spring", &PreloadAdvice::linear_error},
        Line{"friction f_s + f_sm", &PreloadAdvice::friction},
        Line{"smallest collision, linear", &PreloadAdvice::collision_linear},
        Line{"smallest collision, stage 1's choice", &PreloadAdvice::collision_model}}) {
    Trace trace{line.name, TraceStyle::interval, series++, {}, {}, {}, {}, {}};
    for (const PreloadAdvice& a : advice) {
      const bool has_sd = line.value == &PreloadAdvice::friction && std::isfinite(a.friction_sd);
      const double reach = has_sd ? 2 * a.friction_sd : 0;
      trace.labels.push_back(a.cell);
      trace.y.push_back(a.*line.value);
      trace.low.push_back(a.*line.value - reach);
      trace.high.push_back(a.*line.value + reach);
    }
    figure.traces.push_back(std::move(trace));
  }
  return figure;
}

}  // namespace

void add_preload_advice(const BatchResult& result, Document& document) {
  const AdviceDetector detector;
  const std::vector<PreloadAdvice> advice = preload_advice(result.cells, detector);
  if (advice.size() < 2) return;
  const Axes axes = axes_of(result);
  document.tables.push_back(advice_table(advice, detector, axes));
  document.figures.insert(document.figures.begin(), advice_figure(advice, axes));
}

}  // namespace cablefit
