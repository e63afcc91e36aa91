// MODEL, the first of the arguments of commands that apply one to logs.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/model.hpp"
#include "options/common_options.hpp"

namespace cablefit::apps {

/// Taken off the front of options.logs: a .json file, else OUT/dynamic.json. Throws Error(usage)
/// when there is neither; `command` is named in the remedy.
std::string take_model_path(CommonOptions& options, const std::string& command);

/// MODEL LOG, --model, --preload and --rig. `results`: what MODEL may be beside a model file.
void add_model_options(CLI::App& app, CommonOptions& options, std::string& model,
                       const std::string& results);

/// The logs as the model sees them, weighed. All problems of all logs are reported at once.
std::vector<LogSurvey> survey_for_model(const Model& model, const std::vector<std::string>& paths,
                                        const CommonOptions& options);

/// The path of a result file below --out.
std::string below_out(const CommonOptions& options, const std::string& file);

/// A file of rows that an option writes.
struct RowFile {
  std::string option;  ///< "--trajectories"
  std::string rows;    ///< "trajectories"
  std::string path;    ///< empty: none is written
};

/// It never takes the place of what it is made from, nor of another result of the same run: throws
/// Error(usage). `others`: more files of the run.
void require_own_place(const RowFile& file, const CommonOptions& options,
                       std::vector<std::string> others);

}  // namespace cablefit::apps
