#include "cablefit/simulate/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/simulate/part_replay.hpp"
#include "cablefit/simulate/replay_figures.hpp"
#include "cablefit/simulate/trajectory_file.hpp"

namespace cablefit {
namespace {

/// Rows of the log of that number, from 1.
using TrajectorySink = std::function<void(std::size_t, const ReplayedRows&)>;

bool has_part_of_model(const Model& model, const LogSurvey& log) {
  return std::any_of(log.parts.begin(), log.parts.end(),
                     [&](const PartSurvey& part) { return is_of_model(model, part); });
}

/// Logs run side by side, unless the rows of one file are written in their order; the threads that
/// this leaves simulate the band.
int log_threads(const ReplayOptions& options) {
  return options.trajectories.empty() ? options.threads : 1;
}
int band_threads(const ReplayOptions& options, std::size_t n_logs) {
  if (!options.band) return 0;
  const int busy = std::min(log_threads(options), static_cast<int>(n_logs));
  return std::max(1, options.threads / std::max(1, busy));
}

/// One replay per part of the log, empty for those left out.
std::vector<std::unique_ptr<PartReplay>> plan_parts(const Model& model, const LogSurvey& log,
                                                    std::size_t log_number, std::size_t n_logs,
                                                    const ReplayOptions& options,
                                                    SimulateResult& result) {
  const bool of_model = has_part_of_model(model, log);
  std::vector<std::unique_ptr<PartReplay>> replays;
  for (const PartSurvey& part : log.parts) {
    std::unique_ptr<PartReplay>& replay = replays.emplace_back();
    const std::string where = fmt::format("{}: preload {}", log.plan.path, in_quotes(part.preload));
    if (of_model && !is_of_model(model, part)) {
      result.warnings.push_back(
          fmt::format("{} is left out, the model is of {}", where, in_quotes(model.preload)));
      continue;
    }
    if (model.rigid && part.phase == Phase::blocked) {
      result.warnings.push_back(where + " is left out, a rigid drive cannot move a blocked link");
      continue;
    }
    if (!of_model) {
      result.warnings.push_back(
          fmt::format("{} is simulated by a model of preload {}", where, in_quotes(model.preload)));
    }
    replay = std::make_unique<PartReplay>(plan_experiment(model, log, part, options), log, part,
                                          log_number, band_threads(options, n_logs));
  }
  return replays;
}

class LogReplay {
 public:
  LogReplay(const Model& model, const LogSurvey& log, std::size_t log_number, std::size_t n_logs,
            const ReplayOptions& options, SimulateResult& result)
      : log_(log),
        halo_(replay_halo(model)),
        replays_(plan_parts(model, log, log_number, n_logs, options, result)),
        figures_(log.parts.size()) {
    for (std::size_t k = 0; options.figures && k < replays_.size(); ++k)
      if (replays_[k]) figures_[k].emplace(log, log.parts[k], replays_[k]->result().closed_loop);
  }

  bool is_empty() const {
    return std::none_of(replays_.begin(), replays_.end(), [](const auto& r) { return bool(r); });
  }

  std::vector<SimulatedPart> run(const RowSink& sink) {
    const auto wanted = [&](const PartSurvey& part) {
      return bool(replays_[static_cast<std::size_t>(&part - log_.parts.data())]);
    };
    const WindowCounts counts =
        for_each_window(log_, wanted, halo_, kFewestRows, 0.0, [&](Window&& window) {
          std::optional<ReplayFigures>& figures = figures_[window.part];
          if (!figures) {
            replays_[window.part]->add(window, sink);
            return true;
          }
          replays_[window.part]->add(window, [&](const ReplayedRows& rows) {
            figures->add(rows);
            if (sink) sink(rows);
          });
          return true;
        });
    std::vector<SimulatedPart> parts;
    for (std::size_t k = 0; k < replays_.size(); ++k) {
      if (!replays_[k]) continue;
      parts.push_back(replays_[k]->result());
      parts.back().counts = counts;
      if (figures_[k]) parts.back().figures = figures_[k]->figures();
    }
    return parts;
  }

 private:
  const LogSurvey& log_;
  Eigen::Index halo_;
  std::vector<std::unique_ptr<PartReplay>> replays_;
  std::vector<std::optional<ReplayFigures>> figures_;  ///< by part, when asked for
};

std::vector<LogReplay> plan_logs(const Model& model, std::span<const LogSurvey> logs,
                                 const ReplayOptions& options, SimulateResult& result) {
  std::vector<LogReplay> replays;
  for (const LogSurvey& log : logs) {
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
    const std::size_t number = replays.size();
    replays.emplace_back(model, log, number, logs.size(), options, result);
  }
  const bool nothing = std::all_of(replays.begin(), replays.end(),
                                   [](const LogReplay& replay) { return replay.is_empty(); });
  if (nothing && !logs.empty()) {
    throw input_error({logs.front().plan.path}, "nothing to simulate",
                      "a rigid drive needs a log in which the link is free");
  }
  return replays;
}

/// The logs side by side on their own threads; their results in order.
void run_logs(std::vector<LogReplay>& replays, int threads, const TrajectorySink& sink,
              SimulateResult& result) {
  ordered_pipeline<std::size_t>(
      threads,
      [&](auto emit) {
        for (std::size_t k = 0; k < replays.size(); ++k) emit(std::size_t{k});
      },
      [&](std::size_t k) {
        if (!sink) return replays[k].run(nullptr);
        return replays[k].run([&](const ReplayedRows& rows) { sink(k + 1, rows); });
      },
      [&](std::vector<SimulatedPart> parts) {
        std::move(parts.begin(), parts.end(), std::back_inserter(result.parts));
      });
}

}  // namespace

SimulateResult simulate_logs(const Model& model, std::span<const LogSurvey> logs,
                             const ReplayOptions& options) {
  SimulateResult result;
  result.warnings = input_warnings(logs);
  result.model_name = model.name;
  result.preload = model.preload;
  result.rig_path = model.rig.path;
  result.axes = model.rig.axes.all();
  result.trajectories = options.trajectories;
  std::vector<LogReplay> replays = plan_logs(model, logs, options, result);
  if (options.trajectories.empty()) {
    run_logs(replays, log_threads(options), nullptr, result);
    return result;
  }
  TrajectoryFile file(options.trajectories, model, options.band && !model.covariance.empty());
  const auto write = [&](std::size_t log, const ReplayedRows& rows) { file.add(log, rows); };
  run_logs(replays, log_threads(options), write,
           result);  // rows of the file in the order of the logs
  file.finish();
  return result;
}

}  // namespace cablefit
