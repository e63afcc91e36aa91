#include "cablefit/identify/results/identify_figures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "cablefit/elastic/figures/cable_figure.hpp"
#include "cablefit/elastic/figures/mode_figure.hpp"
#include "cablefit/identify/results/recursive.hpp"

namespace cablefit {
namespace {

Figure profile_figure(const ElongationProfile& profile, double scale, const std::string& unit) {
  Figure figure;
  figure.section = profile.preload;
  figure.group = "initial elongations";
  figure.title = "Profile likelihood of " + profile.name;
  figure.caption =
      "The best fit for each fixed l_o, all other parameters fitted again. The 95 % "
      "interval lies below the dashed line. If the curve stays below it on one side, "
      "the logs do not bound l_o there.";
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

std::vector<Figure> cable_figures(std::span<const LogSurvey> logs, const IdentifyPreload& preload,
                                  Axes axes) {
  const auto of_preload = [&](const PartSurvey& part) { return part.preload == preload.name; };
  std::vector<Figure> figures;
  const int n_joints = preload.transmission.n_joints;
  if (n_joints == 1) {
    std::vector<ComparedModel> line;
    if (!preload.lines.empty()) {
      line.push_back({"classical linear, K (theta - q)", {}});
      line.back().transmission.linear_stiffness =
          Eigen::VectorXd::Constant(1, preload.lines.front().measured);
    }
    figures.push_back(cable_figure(preload.transmission, preload.deflection_low,
                                   preload.deflection_high, axes, line));
  }
  for (int joint = 0; joint < n_joints; ++joint) {
    figures.push_back(mode_figure(preload.transmission, joint,
                                  seen_range(logs, of_preload, Channel::q, joint),
                                  seen_range(logs, of_preload, Channel::theta, joint), axes));
    if (n_joints > 1) figures.back().title += fmt::format(", joint {}", joint + 1);
  }
  return figures;
}

}  // namespace

std::vector<Figure> identify_figures(std::span<const LogSurvey> logs,
                                     const IdentifyResult& result) {
  std::vector<Figure> figures;
  const std::string unit = result.cable_space ? "mm" : unit_for(result.axes, "mrad");
  for (const IdentifyPreload& preload : result.preloads) {
    if (!preload.knows_elongations()) continue;
    for (Figure& figure : cable_figures(logs, preload, result.axes)) {
      figure.section = preload.name;
      figure.group = "cables";
      figures.push_back(std::move(figure));
    }
  }
  for (const ElongationProfile& profile : result.profiles)
    figures.push_back(profile_figure(profile, 1e3, unit));
  if (result.trace)
    for (Figure& figure : trace_figures(*result.trace)) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace cablefit
