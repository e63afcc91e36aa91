#include "cablefit/report/sections/batch_figures.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace cablefit {
namespace {

/// One estimate and where it comes from.
struct Found {
  const BatchCell* cell;
  std::string stage, model;
  const Estimate* estimate;
};

/// A way to look at the parameters of a campaign.
struct View {
  const char* section;
  const char* axis;
  const char* caption;
  std::string (*place)(const Found& found);  ///< along the axis
  std::string (*trace)(const Found& found);  ///< what is joined, or has one colour
};

std::string with(const std::string& text, const std::string& more) {
  return more.empty() ? text : text + ", " + more;
}

/// Bars of one preload at several dates stand at one place.
constexpr View kByPreload = {
    "Parameters against preload", kPreloadAxis,
    "Bars: 95 % intervals. A parameter of the robot itself should not depend on the preload.",
    [](const Found& found) { return found.cell->preload; },
    [](const Found& found) { return with(found.model, found.cell->robot); }};

constexpr View kByDate = {
    "Parameters against date", kDateAxis,
    "Bars: 95 % intervals. A change shows as a step, drift and wear as a slope.",
    [](const Found& found) { return found.cell->date; },
    [](const Found& found) {
      return with(with(found.model, found.cell->preload), found.cell->robot);
    }};

template <class Preloads>
void collect(const BatchCell& cell, const char* stage, const Preloads& preloads,
             std::vector<Found>& all) {
  for (const auto& preload : preloads)
    for (const auto& fit : preload.fits)
      for (const Estimate& e : fit.parameters)
        if (e.not_identifiable.empty() && std::isfinite(e.value))
          all.push_back({&cell, stage, fit.model, &e});
}

std::vector<Found> all_estimates(const BatchResult& result) {
  std::vector<Found> all;
  for (const BatchCell& cell : result.cells)
    if (cell.elastic) collect(cell, "Stage 1", cell.elastic->preloads, all);
  for (const BatchCell& cell : result.cells)
    if (cell.dynamic) collect(cell, "Stage 2", cell.dynamic->preloads, all);
  return all;
}

Figure& figure_of(std::vector<Figure>& figures, const View& view, const Found& found) {
  const auto same = std::find_if(figures.begin(), figures.end(), [&](const Figure& figure) {
    return figure.group == found.stage && figure.title == found.estimate->name;
  });
  if (same != figures.end()) return *same;
  Figure figure;
  figure.section = view.section;
  figure.group = found.stage;
  figure.title = found.estimate->name;
  figure.caption = view.caption;
  figure.x = {view.axis, ""};
  figure.y = {found.estimate->name, found.estimate->unit};
  figures.push_back(std::move(figure));
  return figures.back();
}

/// Colours go by the order in which traces come, the same on every figure.
Trace& trace_of(Figure& figure, const std::vector<std::string>& names, const std::string& name) {
  const auto same = std::find_if(figure.traces.begin(), figure.traces.end(),
                                 [&](const Trace& trace) { return trace.name == name; });
  if (same != figure.traces.end()) return *same;
  const auto place = std::find(names.begin(), names.end(), name) - names.begin();
  figure.traces.push_back(
      {name, TraceStyle::interval, static_cast<int>(place) + 1, {}, {}, {}, {}, {}});
  return figure.traces.back();
}

void add_point(Trace& trace, const std::string& place, const Estimate& e) {
  trace.labels.push_back(place);
  trace.y.push_back(e.value);
  trace.low.push_back(std::isfinite(e.ci_low) ? e.ci_low : e.value);
  trace.high.push_back(std::isfinite(e.ci_high) ? e.ci_high : e.value);
}

bool has_one_place(const Figure& figure) {
  std::set<std::string> places;
  for (const Trace& trace : figure.traces) places.insert(trace.labels.begin(), trace.labels.end());
  return places.size() < 2;
}

/// Parameters that are known at one place only have nothing to be compared with.
std::vector<Figure> figures_of(const View& view, const std::vector<Found>& all) {
  std::vector<Figure> figures;
  std::vector<std::string> names;
  for (const Found& found : all) {
    const std::string place = view.place(found);
    if (place.empty()) continue;
    const std::string name = view.trace(found);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    add_point(trace_of(figure_of(figures, view, found), names, name), place, *found.estimate);
  }
  std::erase_if(figures, has_one_place);
  return figures;
}

}  // namespace

std::vector<Figure> parameter_figures(const BatchResult& result) {
  const std::vector<Found> all = all_estimates(result);
  std::vector<Figure> figures = figures_of(kByPreload, all);
  for (Figure& figure : figures_of(kByDate, all)) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace cablefit
