#include "cablefit/report/batch_figures.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "cablefit/dynamic/dynamic_fit.hpp"

namespace cablefit {
namespace {

constexpr const char* kSection = "Parameters against preload";
constexpr const char* kCaption =
    "Bars: 95 % intervals. A parameter of the robot itself should not depend on the preload.";

/// As in the figures of each stage: by the place in the table of models.
int series_of(const std::string& model) {
  const auto models = dynamic_models();
  for (std::size_t k = 0; k < models.size(); ++k)
    if (models[k].name == model) return static_cast<int>(k) + 1;
  return static_cast<int>(models.size()) + 1;
}

Figure& figure_of(std::vector<Figure>& figures, const std::string& group, const Estimate& e) {
  const auto same = std::find_if(figures.begin(), figures.end(), [&](const Figure& figure) {
    return figure.group == group && figure.title == e.name;
  });
  if (same != figures.end()) return *same;
  Figure figure;
  figure.section = kSection;
  figure.group = group;
  figure.title = e.name;
  figure.caption = kCaption;
  figure.x = {"preload", ""};
  figure.y = {e.name, e.unit};
  figures.push_back(std::move(figure));
  return figures.back();
}

Trace& trace_of(Figure& figure, const std::string& model) {
  const auto same = std::find_if(figure.traces.begin(), figure.traces.end(),
                                 [&](const Trace& trace) { return trace.name == model; });
  if (same != figure.traces.end()) return *same;
  figure.traces.push_back({model, TraceStyle::interval, series_of(model), {}, {}, {}, {}, {}});
  return figure.traces.back();
}

void add_estimates(std::vector<Figure>& figures, const std::string& group,
                   const std::string& preload, const std::string& model,
                   const std::vector<Estimate>& estimates) {
  for (const Estimate& e : estimates) {
    if (!e.not_identifiable.empty() || !std::isfinite(e.value)) continue;
    Trace& trace = trace_of(figure_of(figures, group, e), model);
    trace.labels.push_back(preload);
    trace.y.push_back(e.value);
    trace.low.push_back(std::isfinite(e.ci_low) ? e.ci_low : e.value);
    trace.high.push_back(std::isfinite(e.ci_high) ? e.ci_high : e.value);
  }
}

bool has_one_preload(const Figure& figure) {
  std::set<std::string> preloads;
  for (const Trace& trace : figure.traces)
    preloads.insert(trace.labels.begin(), trace.labels.end());
  return preloads.size() < 2;
}

}  // namespace

std::vector<Figure> parameter_figures(const ElasticResult& elastic, const DynamicResult& dynamic) {
  std::vector<Figure> figures, second;
  for (const ElasticPreload& preload : elastic.preloads)
    for (const ElasticFit& fit : preload.fits)
      add_estimates(figures, "Stage 1", preload.name, fit.model, fit.parameters);
  for (const DynamicPreload& preload : dynamic.preloads)
    for (const DynamicFit& fit : preload.fits)
      add_estimates(second, "Stage 2", preload.name, fit.model, fit.parameters);
  figures.insert(figures.end(), second.begin(), second.end());
  std::erase_if(figures, has_one_preload);
  return figures;
}

}  // namespace cablefit
