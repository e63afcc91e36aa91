// Options that all commands share: they name the logs to read and the files to write.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cablefit/report/parts/document.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit::apps {

struct CommonOptions {
  std::vector<std::string> logs;
  std::vector<std::string> more_inputs;  ///< other files read, which no result may replace
  std::string rig;
  std::string out = "cablefit-out";
  std::string json;  ///< "-": standard output, and nothing else there
  std::vector<std::string> reports;
  bool quiet = false;
  bool verbose = false;
  Reading reading;
  SampleOptions samples;
  std::string preload;
  bool robust_sd = true;
  unsigned long seed = 1;  ///< of random numbers, for commands that draw any
};

/// One per core, at most 8.
int default_threads();
/// --trust-units, --missing, --repeated, --skip, --units-row, --rate.
void add_reading_options(CLI::App& app, Reading& reading);
/// LOG..., --rig, --preload, and how logs are read.
void add_log_options(CLI::App& app, CommonOptions& options);
/// --model and --preload: which fit of a result. `preload_default`: what it is without.
void add_choice_of_fit(CLI::App& app, std::string& model, std::string& preload,
                       const std::string& preload_default);
/// --out, --json, --report, --threads, --quiet, --verbose, --seed.
void add_output_options(CLI::App& app, CommonOptions& options);
/// --torque-hold, --cutoff, --filter-order, --decimate, --drop-edge, --rest-speed.
void add_sample_options(CLI::App& app, CommonOptions& options);
/// --sd honest|white.
void add_sd_option(CLI::App& app, CommonOptions& options);

/// Whether a --report shows plots, so that figures are worth a pass over the logs.
bool wants_figures(const CommonOptions& options);

/// Surveys every log, each with its rig. All problems of all logs are reported at once. Throws
/// Error(usage) without logs, for one given twice and for a --preload that none of them has.
std::vector<LogSurvey> read_logs(const CommonOptions& options);

}  // namespace cablefit::apps
