// cablefit simulate: a model on the input of logs.
#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/report/documents/simulate_document.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/simulate_json.hpp"
#include "cablefit/simulate/replay.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/model_argument.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kSimulateExample =
    "Example, after 'cablefit elastic' and 'cablefit dynamic':\n"
    "  cablefit simulate cablefit-out/dynamic.json data/low/moving_load30.csv --preload low\n"
    "MODEL left out: OUT/dynamic.json. Exit code 4: a simulation diverged.\n";

constexpr const char* kSimulationFile = "simulate.json";

struct SimulateCommand {
  CommonOptions common;  ///< its logs: MODEL and the logs
  ReplayOptions replay;
  std::string model;  ///< --model
};

void add_replay_options(CLI::App& app, ReplayOptions& replay) {
  add_choice(
      app, "--mode", "mode", {"auto", "closed-loop", "torque"},
      [&replay](const std::string& name) {
        replay.mode = name == "auto"     ? ReplayMode::automatic
                      : name == "torque" ? ReplayMode::torque
                                         : ReplayMode::closed_loop;
      },
      "by the rig's controller, or by the torque of the log [auto: the controller if its "
      "reference is in the log]");
  add_number(
      app, "--window", "S", {0}, [&replay](double seconds) { replay.window = seconds; },
      "restart from the measured state at this interval; 0: never [torque: 1, closed "
      "loop: 0]");
  add_choice(
      app, "--torque-hold", "torque hold", {"auto", "zoh", "none"},
      [&replay](const std::string& name) {
        replay.torque_hold = name == "zoh"    ? TorqueHold::zoh
                             : name == "none" ? TorqueHold::none
                                              : TorqueHold::automatic;
      },
      "whether a replayed tau is held until the next row (zoh) or is linear between "
      "rows (none)");
  add_number(
      app, "--step", "S", {1e-9, 1}, [&replay](double seconds) { replay.step = seconds; },
      "longest step of the integration [25e-6; links that move each other: 25e-6 to 50e-6]");
  app.add_flag_callback(
      "--no-band", [&replay] { replay.band = false; },
      "no 95 % band of the parameters' covariance: faster, by one simulation per parameter");
  app.add_option("--trajectories", replay.trajectories,
                 "CSV of every row, measured and simulated, with its band and cable tensions")
      ->type_name("FILE");
}

SimulateResult run_simulation(SimulateCommand& command) {
  const std::string path = take_model_path(command.common, "simulate");
  command.common.more_inputs.push_back(path);
  require_own_place({"--trajectories", "trajectories", command.replay.trajectories}, command.common,
                    {path, below_out(command.common, kSimulationFile)});
  std::string choice;
  const Model model = read_model(path, command.common.preload, command.model, choice);
  const std::vector<std::string>& paths = command.common.logs;
  if (paths.empty()) throw usage_error("no log given", "name one or more logs after MODEL");
  const std::vector<LogSurvey> logs = [&] {
    const Progress progress(command.common.quiet, "reading logs");
    return survey_for_model(model, paths, command.common);
  }();
  const Progress progress(command.common.quiet, "simulating");
  command.replay.figures = wants_figures(command.common);
  command.replay.threads = command.common.samples.threads;
  SimulateResult result = simulate_logs(model, logs, command.replay);
  result.model_path = path;
  result.model_choice = choice;
  result.inputs.insert(result.inputs.begin(), {path, sha256_of_file(path), 0});
  return result;
}

/// Exit code 4, with every place where a simulation ended.
void throw_if_diverged(const SimulateResult& result) {
  Problems problems;
  for (const SimulatedPart& part : result.parts) {
    if (!part.diverged.empty()) problems.add(Error(ErrorKind::not_identifiable, part.diverged));
  }
  problems.throw_if_any();
}

}  // namespace

int run_simulate(const Arguments& arguments) {
  CLI::App app("Run a model on the input of logs: positions, torques, gap to the measurement.",
               "simulate");
  SimulateCommand command;
  command.replay.band = true;
  add_model_options(app, command.common, command.model, "'cablefit dynamic'");
  add_replay_options(app, command.replay);
  add_reading_options(app, command.common.reading);
  add_output_options(app, command.common);
  app.footer(kSimulateExample);
  if (!parse(app, arguments)) return 0;

  const SimulateResult result = run_simulation(command);
  deliver(command.common, simulate_document(result), {{kSimulationFile, simulate_json(result)}});
  throw_if_diverged(result);
  return 0;
}

}  // namespace cablefit::apps
