#include "cablefit/refine/figures/refine_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cablefit/figure/autocorrelation.hpp"
#include "cablefit/figure/binned_mean.hpp"
#include "cablefit/figure/new_trace.hpp"
#include "cablefit/figure/thinned_line.hpp"
#include "cablefit/refine/figures/outcome_figures.hpp"
#include "cablefit/refine/figures/shown_rows.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/rows/regime_variables.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kFewestBins = 4, kMostBins = 96;
constexpr std::size_t kFewRows = 10;       // a mean over fewer says nothing
constexpr std::size_t kSparse = 10;        // bins with a tenth of the mean number of rows: chance
constexpr std::size_t kMostVariables = 3;  // per equation, those that reveal most

/// One equation before and after, on its way to figures.
struct Pair {
  std::string section, group, unit;
  Axes axes = Axes::rotary;
  bool link = false, changed = false;
  double floor = 0;
  ShownRows before, after;
  std::array<const ShownRows*, 2> both() const { return {&before, &after}; }
};

/// Without anything added there is no before and after.
std::string name_of(const Pair& pair, std::size_t k) {
  if (!pair.changed) return "residual";
  return k == 0 ? "before" : "after";
}
int series_of(std::size_t k) { return k == 0 ? kBefore : kAfter; }

Figure blank(const Pair& pair, std::string title) {
  Figure figure;
  figure.section = pair.section;
  figure.group = pair.group;
  figure.title = std::move(title);
  figure.rank = FigureRank::detail;
  figure.y = {"residual", pair.unit};
  return figure;
}

/// Without anything added there is no after.
std::size_t n_states(const Pair& pair) { return pair.changed ? 2 : 1; }

Figure over_time(const Pair& pair, const Timeline& time) {
  Figure figure = blank(pair, "Residual over time");
  figure.caption =
      fmt::format("Measured minus predicted; noise floor {:.3g} {} rms.", pair.floor, pair.unit);
  figure.x = {"time, logs one after the other", "s"};
  figure.marks = time.marks;
  figure.wide = true;
  figure.rank = FigureRank::shown;
  for (std::size_t k = 0; k < n_states(pair); ++k) {
    ThinnedLine line(0, time.end, time.spacing);
    for (const ShownRow& row : pair.both()[k]->rows) line.add(row.t, row.residual);
    figure.traces.push_back(new_trace(
        fmt::format("{}, {:.3g} {} rms", name_of(pair, k), pair.both()[k]->rms, pair.unit),
        TraceStyle::line, series_of(k)));
    line.draw(figure.traces.back());
  }
  return figure;
}

constexpr std::size_t kBackward = 0, kForward = 1;

/// Few rows share few bins.
std::size_t n_bins(const ShownRows& kind) {
  return std::clamp(kind.rows.size() / (2 * kFewRows), kFewestBins, kMostBins);
}

/// Rows that a bin needs to be drawn.
std::size_t few_rows(const ShownRows& kind) {
  return std::max(kFewRows, kind.rows.size() / (kSparse * n_bins(kind)));
}

/// Mean residual over bins of a variable, apart by the direction of motion: friction changes sides.
BinnedMean mean_of(const ShownRows& kind, std::size_t variable, std::size_t direction,
                   std::size_t speed) {
  BinnedMean mean(n_bins(kind));
  for (const ShownRow& row : kind.rows)
    if ((row.variables[speed] > 0) == (direction == kForward))
      mean.add(row.variables[variable], row.residual);
  return mean;
}

std::size_t place_of(std::string_view regime) {
  const auto all = regime_variables();
  return static_cast<std::size_t>(
      std::find_if(all.begin(), all.end(),
                   [&](const RegimeVariable& v) { return v.regime == regime; }) -
      all.begin());
}

bool is_plotted(const RegimeVariable& variable) {
  return variable.regime != "direction" && variable.regime != "time";
}

/// Mean squared mean of the residual over the bins: what of it is a function of the variable.
double explained(const ShownRows& kind, std::size_t variable) {
  const std::size_t speed = place_of("speed");
  double sum = 0, n = 0;
  for (const std::size_t direction : {kForward, kBackward}) {
    Trace mean;
    mean_of(kind, variable, direction, speed).draw(mean, few_rows(kind), false);
    for (const double y : mean.y) {
      sum += y * y;
      ++n;
    }
  }
  return n > 0 ? sum / n : 0;
}

/// The variables of which the residual before was most a function.
std::vector<std::size_t> revealing(const Pair& pair) {
  const auto all = regime_variables();
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t v = 0; v < all.size(); ++v) {
    const auto& rows = pair.before.rows;
    const auto [low, high] = std::minmax_element(
        rows.begin(), rows.end(),
        [v](const ShownRow& a, const ShownRow& b) { return a.variables[v] < b.variables[v]; });
    if (is_plotted(all[v]) && high->variables[v] > low->variables[v])
      ranked.emplace_back(-explained(pair.before, v), v);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < std::min(kMostVariables, ranked.size()); ++k)
    chosen.push_back(ranked[k].second);
  return chosen;
}

FigureAxis axis_of(const RegimeVariable& variable, bool link, Axes axes) {
  return {std::string(link ? variable.link : variable.motor), regime_unit(variable.regime, axes)};
}

/// What of the residual is a function of the variable: noise averages out.
Figure mean_against(const Pair& pair, std::size_t variable) {
  const RegimeVariable& v = regime_variables()[variable];
  Figure figure = blank(pair, fmt::format("Mean residual against {}", v.regime));
  figure.caption = "Solid: forward motion; dashed: backward.";
  figure.x = axis_of(v, pair.link, pair.axes);
  figure.y = {"mean residual", pair.unit};
  const std::size_t speed = place_of("speed");
  for (std::size_t k = 0; k < n_states(pair); ++k)
    for (const std::size_t direction : {kForward, kBackward}) {
      Trace mean =
          new_trace(name_of(pair, k) + (direction == kForward ? "" : ", backward"),
                    direction == kForward ? TraceStyle::line : TraceStyle::dashed, series_of(k));
      mean_of(*pair.both()[k], variable, direction, speed)
          .draw(mean, few_rows(*pair.both()[k]), true);
      if (!mean.x.empty()) figure.traces.push_back(std::move(mean));
    }
  return figure;
}

/// Rms of the residual over bins of a variable, against the floor.
Figure rms_against(const Pair& pair, std::size_t variable) {
  const RegimeVariable& v = regime_variables()[variable];
  Figure figure = blank(pair, fmt::format("Size of the residual by {}", v.regime));
  figure.x = axis_of(v, pair.link, pair.axes);
  figure.y = {"rms of the residual", pair.unit};
  for (std::size_t k = 0; k < n_states(pair); ++k) {
    BinnedMean mean(n_bins(pair.before));
    for (const ShownRow& row : pair.both()[k]->rows)
      mean.add(row.variables[variable], row.residual * row.residual);
    Trace trace = new_trace(name_of(pair, k), TraceStyle::line, series_of(k));
    mean.draw(trace, few_rows(pair.before), true);
    for (double& y : trace.y) y = std::sqrt(y);
    if (!trace.x.empty()) figure.traces.push_back(std::move(trace));
  }
  if (figure.traces.empty()) return figure;
  Trace floor = new_trace("noise floor", TraceStyle::dashed, kReference);
  floor.x = {figure.traces.front().x.front(), figure.traces.front().x.back()};
  floor.y = {pair.floor, pair.floor};
  figure.traces.push_back(std::move(floor));
  return figure;
}

Figure memory(const Pair& pair) {
  Figure figure = blank(pair, "Autocorrelation of the residual");
  figure.caption = fmt::format(
      "One row every {:.3g} ms. Values away from 0 beyond the first lags are "
      "structure.",
      1e3 * pair.before.row_period);
  figure.x = {"lag", "rows"};
  figure.y = {"autocorrelation", ""};
  for (std::size_t k = 0; k < n_states(pair); ++k) {
    const ShownRows& kind = *pair.both()[k];
    Eigen::VectorXd values(static_cast<Eigen::Index>(kind.rows.size()));
    for (Eigen::Index i = 0; i < values.size(); ++i)
      values(i) = kind.rows[static_cast<std::size_t>(i)].residual;
    Autocorrelation correlation;
    correlation.add(kind.numbers, values);
    figure.traces.push_back(new_trace(name_of(pair, k), TraceStyle::line, series_of(k)));
    correlation.draw(figure.traces.back());
  }
  return figure;
}

enum class Detail { full, over_time };

/// The equation in which the gap shows: that of the effect, else that where the model misses most.
bool shows_gap(const RefineResult& result, RowKind kind) {
  std::string_view equation = to_string(result.elastic_only ? RowKind::blocked : RowKind::motor);
  if (!result.where.empty()) equation = result.where.front().equation;
  if (!result.effects.empty() && result.effects.front().instance.effect != nullptr) {
    const std::string_view side = to_string(result.effects.front().instance.effect->site);
    if (side == to_string(RowKind::link) || side == to_string(RowKind::motor)) equation = side;
  }
  return equation == to_string(kind);
}

void add_residuals(const BeforeAfter& rows, const std::string& section, Detail detail,
                   const RefineResult& result, std::vector<Figure>& figures) {
  for (const RowKind kind : {RowKind::motor, RowKind::link, RowKind::blocked}) {
    const Timeline time = timeline_of(rows.before, rows.logs, kind);
    const Pair pair{section,
                    fmt::format("{} equation", to_string(kind)),
                    torque_unit(result.axes),
                    result.axes,
                    kind == RowKind::link,
                    rows.after.added.size() > rows.before.added.size(),
                    rows.floor[static_cast<std::size_t>(kind)],
                    shown_rows(rows.before, rows.x_before, kind, time),
                    shown_rows(rows.after, rows.x_after, kind, time)};
    if (pair.before.rows.empty()) continue;
    figures.push_back(over_time(pair, time));
    if (detail == Detail::over_time) continue;
    FigureRank rank = shows_gap(result, kind) ? FigureRank::main : FigureRank::shown;
    for (const std::size_t variable : revealing(pair)) {
      if (Figure mean = mean_against(pair, variable); !mean.traces.empty()) {
        mean.rank = std::exchange(rank, FigureRank::detail);  // the first reveals most
        figures.push_back(std::move(mean));
      }
      if (Figure rms = rms_against(pair, variable); !rms.traces.empty())
        figures.push_back(std::move(rms));
    }
    figures.push_back(memory(pair));
  }
}

}  // namespace

std::vector<Figure> refine_figures(const RefineResult& result, const BeforeAfter& train,
                                   const BeforeAfter& test, const TestLogs& simulated) {
  std::vector<Figure> figures = outcome_figures(result);
  add_residuals(train, "Logs that were fitted", Detail::full, result, figures);
  if (!result.elastic_only && !simulated.logs.empty()) {
    const bool changed = test.after.added.size() > test.before.added.size();
    Figure figure =
        simulated_figure(simulated, models_with(test.before, test.x_before),
                         changed ? models_with(test.after, test.x_after) : std::vector<Model>{});
    if (!figure.traces.empty()) figures.push_back(std::move(figure));
  }
  add_residuals(test, "Held-out logs", Detail::over_time, result, figures);
  return figures;
}

}  // namespace cablefit
