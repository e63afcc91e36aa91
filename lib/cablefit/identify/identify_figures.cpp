#include "cablefit/identify/identify_figures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "cablefit/elastic/cable_figure.hpp"
#include "cablefit/identify/recursive.hpp"

namespace cablefit {
namespace {

Figure profile_figure(const ElongationProfile& profile, double scale, const std::string& unit) {
  Figure figure;
  figure.section = profile.preload;
  figure.group = "initial elongations";
  figure.title = "Profile likelihood of " + profile.name;
  figure.caption =
      "How much worse the best fit becomes when this l_o stands still and everything else follows. "
      "The 95 % interval lies below the dashed line; a curve that stays below it on one side says "
      "that the logs do not bound l_o there.";
  figure.x = {profile.name, unit};
  figure.y = {"-2 log likelihood ratio", ""};
  Trace line{"profile", TraceStyle::line, 1, {}, {}, {}, {}, {}};
  for (const double l_o : profile.l_o) line.x.push_back(scale * l_o);
  line.y = profile.deviance;
  Trace threshold{"95 %", TraceStyle::dashed, kReference, {}, {}, {}, {}, {}};
  threshold.x = {line.x.front(), line.x.back()};
  threshold.y = {profile.threshold, profile.threshold};
  figure.traces = {line, threshold};
  for (const double end : {profile.low, profile.high})
    if (std::isfinite(end))
      figure.marks.push_back({scale * end, fmt::format("{:.4g}", scale * end)});
  return figure;
}

}  // namespace

std::vector<Figure> identify_figures(const IdentifyResult& result) {
  std::vector<Figure> figures;
  const bool length = result.cable_space || result.linear_motion;
  for (const IdentifyPreload& preload : result.preloads) {
    if (!preload.knows_elongations()) continue;
    figures.push_back(cable_figure(preload.transmission, preload.deflection_low,
                                   preload.deflection_high, result.linear_motion));
    figures.back().section = preload.name;
    figures.back().group = "cables";
  }
  for (const ElongationProfile& profile : result.profiles)
    figures.push_back(profile_figure(profile, 1e3, length ? "mm" : "mrad"));
  if (result.trace)
    for (Figure& figure : trace_figures(*result.trace)) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace cablefit
