#include "cablefit/refine/figures/simulated_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/figure/explained.hpp"
#include "cablefit/figure/new_trace.hpp"
#include "cablefit/figure/thinned_line.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/figures/outcome_figures.hpp"
#include "cablefit/simulate/part_replay.hpp"

namespace cablefit {
namespace {

/// A moving part of a test log, and the place of its model.
struct TestPart {
  const LogSurvey* log = nullptr;
  const PartSurvey* part = nullptr;
  std::size_t model = 0;
};

TestPart first_part(const TestLogs& test, const std::vector<Model>& models) {
  for (const LogSurvey& log : test.logs)
    for (const PartSurvey& part : log.parts)
      for (std::size_t m = 0; m < models.size(); ++m)
        if (part.phase == Phase::moving &&
            (models.size() == 1 || part.preload == models[m].preload))
          return {&log, &part, m};
  return {};
}

struct Lines {
  ThinnedLine measured, simulated;
  Explained explained;
};

/// Throws Error for a log that the model cannot be run on.
Lines replayed(const TestPart& test, const Model& one, double compared) {
  const Model model = whole_of(one);
  const Eigen::Index joint = one.joint;
  ReplayOptions options;
  options.compared = compared;
  const Experiment experiment = plan_experiment(model, *test.log, *test.part, options);
  const double begin = std::max(test.part->t_first, experiment.compared_from);
  const ThinnedLine line(begin, test.part->t_last, test.part->period);
  Lines lines{line, line, {}};
  PartReplay replay(experiment, *test.log, *test.part, 0);
  const auto shown = [&](const Eigen::ArrayXXd& theta, const Eigen::ArrayXXd& q, Eigen::Index i) {
    return kMilli * (model.rigid ? theta(i, joint) : theta(i, joint) - q(i, joint));
  };
  const auto take = [&](const ReplayedRows& rows) {
    for (Eigen::Index i = 0; i < rows.simulated.theta.rows(); ++i) {
      const double t = rows.t0 + static_cast<double>(i) * rows.period;
      if (t < begin) continue;
      const double measured = shown(rows.theta, rows.q, i);
      const double simulated = shown(rows.simulated.theta, rows.simulated.q, i);
      lines.measured.add(t, measured);
      lines.simulated.add(t, simulated);
      lines.explained.add(measured, simulated - measured);
    }
  };
  for_each_window(
      *test.log, [&](const PartSurvey& part) { return &part == test.part; }, replay_halo(model),
      kFewestRows, 0.0,
      [&](Window&& window) {
        replay.add(window, take);
        return true;
      });
  return lines;
}

void add_trace(Figure& figure, const ThinnedLine& line, Trace trace) {
  line.draw(trace);
  figure.traces.push_back(std::move(trace));
}

}  // namespace

Figure simulated_figure(const TestLogs& test, const std::vector<Model>& before,
                        const std::vector<Model>& after) {
  Figure figure;
  const TestPart part = first_part(test, before);
  if (part.log == nullptr) return figure;
  const Model& first = before[part.model];
  const std::string log = std::filesystem::path(part.log->plan.path).filename().string();
  figure.section = "Held-out logs";
  figure.title = fmt::format("Measured and simulated {}", first.rigid ? "theta" : "theta - q");
  figure.caption = fmt::format("{}{}, held out of every fit. Explained: share of the variance.",
                               test.compared < 1 ? "The last part of " : "", log);
  figure.x = {"time", "s"};
  figure.y = {first.rigid ? "motor position theta" : "deflection theta - q",
              unit_for(first.rig.axes.all(), "mrad")};
  figure.wide = true;
  figure.rank = FigureRank::main;
  const auto name = [&after](const char* when, const Lines& lines) {
    return fmt::format("simulated{}, {} explained", after.empty() ? "" : when,
                       lines.explained.about_mean());
  };
  try {
    const Lines given = replayed(part, first, test.compared);
    add_trace(figure, given.measured, new_trace("measured", TraceStyle::broad, kMeasured));
    add_trace(figure, given.simulated,
              new_trace(name(" before", given), TraceStyle::line, kBefore));
    if (!after.empty()) {
      const Lines refined = replayed(part, after[part.model], test.compared);
      add_trace(figure, refined.simulated,
                new_trace(name(" after", refined), TraceStyle::line, kAfter));
    }
  } catch (const Error&) {  // the gap of the simulation says why there is none
    figure.traces.clear();
  }
  return figure;
}

}  // namespace cablefit
