#include "options/model_argument.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "cablefit/base/error.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/samples/weigh/weigh.hpp"
#include "cablefit/simulate/experiment.hpp"

namespace cablefit::apps {
namespace {

bool is_json(const std::string& path) { return std::filesystem::path(path).extension() == ".json"; }

}  // namespace

std::string take_model_path(CommonOptions& options, const std::string& command) {
  std::vector<std::string>& given = options.logs;
  const std::string usual = below_out(options, "dynamic.json");
  if (given.empty())
    throw usage_error("no model and no log given",
                      fmt::format("see 'cablefit {} --help'", command));
  if (is_json(given.front())) {
    const std::string model = given.front();
    given.erase(given.begin());
    return model;
  }
  std::error_code ignored;
  if (std::filesystem::exists(usual, ignored)) return usual;
  throw usage_error(fmt::format("no model given and no {}", usual),
                    "name a model file or a result of 'cablefit dynamic' before the logs");
}

void add_model_options(CLI::App& app, CommonOptions& options, std::string& model,
                       const std::string& results) {
  app.add_option(
         "MODEL LOG", options.logs,
         fmt::format("model file or result of {}, then logs: CSV or JSON, also .gz and .zst",
                     results))
      ->type_name("");
  add_choice_of_fit(app, model, options.preload, "the only one, else the first");
  app.add_option("--rig", options.rig,
                 "rig file; default: rig.json beside each log, else the model's")
      ->type_name("FILE");
}

std::vector<LogSurvey> survey_for_model(const Model& model, const std::vector<std::string>& paths,
                                        const CommonOptions& options) {
  std::vector<LogSurvey> logs;
  Problems problems;
  for (const std::string& path : paths)
    problems.collect(
        [&] { logs.push_back(survey_for_simulation(path, options.rig, model, options.reading)); });
  problems.throw_if_any();
  weigh_logs(logs);
  return logs;
}

std::string below_out(const CommonOptions& options, const std::string& file) {
  return (std::filesystem::path(options.out) / file).string();
}

void require_own_place(const RowFile& file, const CommonOptions& options,
                       std::vector<std::string> others) {
  if (file.path.empty()) return;
  if (file.path == "-")
    throw usage_error(fmt::format("{} cannot be '-'", file.option), "give the name of a file");
  others.insert(others.end(), options.logs.begin(), options.logs.end());
  others.insert(others.end(), options.reports.begin(), options.reports.end());
  others.insert(others.end(), {options.rig, options.json});
  const auto whole = [](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  for (const std::string& other : others) {
    if (other.empty() || whole(other) != whole(file.path)) continue;
    throw usage_error(fmt::format("the {} would overwrite {}", file.rows, other),
                      fmt::format("choose another {}", file.option));
  }
}

}  // namespace cablefit::apps
