// cablefit predict: elastic torques, sensor torques and contacts along logs, without a simulation.
#include "cablefit/predict/predict.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"
#include "cablefit/report/documents/predict_document.hpp"
#include "cablefit/results/elastic_models.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/predict_json.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "options/model_argument.hpp"
#include "output/delivery.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kPredictExample =
    "Examples, after 'cablefit elastic' and 'cablefit dynamic':\n"
    "  cablefit predict cablefit-out/elastic.json data/low/blocked.csv --preload low\n"
    "  cablefit predict cablefit-out/dynamic.json data/low/moving_load30.csv --preload low\n"
    "MODEL left out: OUT/dynamic.json. A result of stage 1 knows the elastic quantities alone.\n";

constexpr const char* kPredictionFile = "predict.json";

struct PredictCommand {
  CommonOptions common;  ///< its logs: MODEL and the logs
  PredictOptions predict;
  std::string model;                ///< --model
  std::vector<std::string> fitted;  ///< --fitted
};

void add_predict_options(CLI::App& app, PredictCommand& command) {
  PredictOptions& predict = command.predict;
  app.add_option(
         "--trajectories", predict.trajectories,
         "CSV of elastic torques, elongations, tensions and energy of every row, with bands")
      ->type_name("FILE");
  app.add_option("--sensed", predict.sensed,
                 "CSV of the torques by the equations of motion beside the logged ones")
      ->type_name("FILE");
  app.add_flag_callback(
      "--no-band", [&predict] { predict.band = false; },
      "no 95 % band of the parameters' covariance");
  app.add_option("--fitted", command.fitted,
                 "moving logs without a contact, such as those of the fit: the detector's noise, "
                 "and its false alarms are counted; give them last")
      ->type_name("LOG ...");
  add_number(
      app, "--window", "S", {1e-6, 1e6}, [&predict](double seconds) { predict.window = seconds; },
      "length over which the detector of contacts averages [0.05]");
  add_number(
      app, "--false-alarms", "N", {1e-9, 1e9},
      [&predict](double alarms) { predict.false_alarms_per_hour = alarms; },
      "false alarms an hour [1]");
}

Model read_any_model(const std::string& path, const std::string& preload, const std::string& name,
                     std::string& choice) {
  if (!is_elastic_result(path)) return read_model(path, preload, name, choice);
  std::vector<Model> models = read_elastic_models(path, preload, name, choice);
  if (models.size() > 1)
    throw usage_error("the result is of several preloads", "choose one with --preload");
  return std::move(models.front());
}

PredictResult run_prediction(PredictCommand& command) {
  CommonOptions& options = command.common;
  const std::string path = take_model_path(options, "predict");
  options.more_inputs.push_back(path);
  options.more_inputs.insert(options.more_inputs.end(), command.fitted.begin(),
                             command.fitted.end());
  const std::string result_file = below_out(options, kPredictionFile);
  const PredictOptions& predict = command.predict;
  require_own_place({"--trajectories", "trajectories", predict.trajectories}, options,
                    {path, result_file});
  require_own_place({"--sensed", "torques", predict.sensed}, options,
                    {path, result_file, predict.trajectories});
  std::string choice;
  const Model model = read_any_model(path, options.preload, command.model, choice);
  if (options.logs.empty()) throw usage_error("no log given", "name one or more logs after MODEL");
  const Progress progress(options.quiet, "reading logs");
  const std::vector<LogSurvey> logs = survey_for_model(model, options.logs, options);
  const std::vector<LogSurvey> fitted = survey_for_model(model, command.fitted, options);
  command.predict.quiet = fitted;
  command.predict.samples = options.samples;
  command.predict.figures = wants_figures(options);
  PredictResult result = predict_logs(model, logs, command.predict);
  result.model_path = path;
  result.model_choice = choice;
  result.inputs.insert(result.inputs.begin(), {path, sha256_of_file(path), 0});
  return result;
}

}  // namespace

int run_predict(const Arguments& arguments) {
  CLI::App app(
      "Predicts along logs: elastic torques, elongations, energy, torque of a sensor, contacts.",
      "predict");
  PredictCommand command;
  add_model_options(app, command.common, command.model, "'cablefit elastic' or 'dynamic'");
  add_predict_options(app, command);
  add_reading_options(app, command.common.reading);
  add_sample_options(app, command.common);
  add_output_options(app, command.common);
  app.footer(kPredictExample);
  if (!parse(app, arguments)) return 0;
  const PredictResult result = run_prediction(command);
  deliver(command.common, predict_document(result), {{kPredictionFile, predict_json(result)}});
  return 0;
}

}  // namespace cablefit::apps
