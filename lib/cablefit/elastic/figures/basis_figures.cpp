#include "cablefit/elastic/figures/basis_figures.hpp"

#include <cmath>

namespace cablefit {
namespace {

Figure blank_figure(const ElasticPreload& preload, const char* title, const char* caption) {
  Figure figure;
  figure.section = preload.name;
  figure.group = "Blocked link: bases of the cable force";
  figure.title = title;
  figure.caption = caption;
  figure.wide = true;
  return figure;
}

Figure basis_stiffness(const ElasticPreload& preload) {
  Figure figure = blank_figure(
      preload, "Stiffness by basis",
      "The slope of the elastic torque, each basis with the number of terms that block "
      "cross-validation chose.");
  figure.x = {"deflection theta - q", preload.unit};
  figure.y = {"stiffness", unit_for(preload.axes, "N m/rad")};
  int series = 0;
  for (const BasisScore& score : preload.bases->scores)
    figure.traces.push_back({score.basis,
                             TraceStyle::line,
                             ++series,
                             score.curve.deflection,
                             score.curve.stiffness,
                             {},
                             {},
                             {}});
  return figure;
}

Figure basis_errors(const ElasticPreload& preload) {
  Figure figure = blank_figure(
      preload, "Error against the number of terms",
      "On held-out blocks; terms chosen and fitted without them. Dashed: scatter about short "
      "lines, which no curve explains.");
  figure.x = {"terms of all cables", ""};
  figure.y = {"error on held-out blocks, rms", torque_unit(preload.axes), true};
  double most = 0;
  int series = 0;
  for (const BasisScore& score : preload.bases->scores) {
    Trace trace{score.basis, TraceStyle::line, ++series, {}, score.path, {}, {}, {}};
    for (std::size_t n = 1; n <= score.path.size(); ++n) trace.x.push_back(static_cast<double>(n));
    most = std::max(most, static_cast<double>(score.path.size()));
    figure.traces.push_back(std::move(trace));
  }
  if (const double floor = preload.bases->floor; std::isfinite(floor))
    figure.traces.push_back(
        {"scatter", TraceStyle::dashed, kReference, {1, most}, {floor, floor}, {}, {}, {}});
  return figure;
}

}  // namespace

std::vector<Figure> basis_figures(const ElasticPreload& preload) {
  return {basis_stiffness(preload), basis_errors(preload)};
}

}  // namespace cablefit
