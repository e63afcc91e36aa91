#include "options/common_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <thread>

#include "cablefit/base/error.hpp"
#include "cablefit/model/rig.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/session/read_logs.hpp"
#include "options/command_line.hpp"
#include "output/progress.hpp"

namespace cablefit::apps {
namespace {

constexpr unsigned kMostThreads = 8;  // beyond, reading the log is what takes the time

/// "zoh" and "none"; "auto" overrides what a rig file says.
TorqueHold torque_hold(const std::string& name) {
  return name == "zoh"    ? TorqueHold::zoh
         : name == "none" ? TorqueHold::none
                          : TorqueHold::automatic;
}

void require_preload(const std::vector<LogSurvey>& logs, const std::string& wanted) {
  if (wanted.empty()) return;
  std::set<std::string> names;
  for (const LogSurvey& log : logs) {
    for (const PartSurvey& part : log.parts) names.insert(part.preload);
  }
  require_known("preload", wanted, {names.begin(), names.end()});
}

}  // namespace

int default_threads() {
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads));
}

void add_reading_options(CLI::App& app, Reading& reading) {
  begin_group(app, "How logs are read");
  app.add_flag("--trust-units", reading.trust_units,
               "continue although the units or signs of a log cannot be right");
  add_choice(
      app, "--missing", "way with missing cells", {"drop", "hold"},
      [&reading](const std::string& way) {
        reading.mending.missing = way == "drop" ? Missing::drop : Missing::hold;
      },
      "rows with a missing cell: drop them, or hold the value of the row before; "
      "both are counted");
  add_choice(
      app, "--repeated", "way with repeated times", {"first"},
      [&reading](const std::string&) { reading.mending.first_of_repeated = true; },
      "of rows with the same time keep the first; the dropped ones are counted");
  add_whole(
      app, "--skip", "N", {0, 1e6},
      [&reading](long n) { reading.skipped_lines = static_cast<std::size_t>(n); },
      "lines of a CSV log before its header");
  app.add_flag("--units-row", reading.units_row,
               "the line after the header of a CSV log holds units");
  add_number(
      app, "--rate", "HZ", {1e-3, 1e9}, [&reading](double hz) { reading.rate = hz; },
      "rate of the rows of a log without time column");
}

void add_log_options(CLI::App& app, CommonOptions& options) {
  app.add_option("LOG", options.logs, "logs: CSV or JSON, also .gz and .zst; - is standard input")
      ->type_name("");
  app.add_option("--rig", options.rig, "rig file; default: rig.json beside each log")
      ->type_name("FILE");
  app.add_option("--preload", options.preload, "only this preload")->type_name("NAME");
  add_reading_options(app, options.reading);
  begin_group(app, "Options");
}

void add_output_options(CLI::App& app, CommonOptions& options) {
  begin_group(app, "Output");
  app.add_option("--out", options.out, "folder of the result files [cablefit-out]")
      ->type_name("DIR");
  app.add_option("--json", options.json, "the whole result as JSON; - for standard output")
      ->type_name("FILE");
  const auto add_report = [&options](const std::vector<std::string>& files) {
    for (const std::string& file : files) (void)report_writer_for(file);
    options.reports = files;
  };
  app.add_option_function<std::vector<std::string>>(
         "--report", add_report,
         "a report; its extension sets the format: .html (with plots), .md, .csv or "
         ".txt; repeatable")
      ->type_name("FILE")
      ->type_size(1)
      ->expected(1, 1000)
      ->allow_extra_args(false);
  options.samples.threads = default_threads();
  add_whole(
      app, "--threads", "N", {1, 1024},
      [&options](long n) { options.samples.threads = static_cast<int>(n); },
      "threads [one per core, at most 8]; the result does not depend on it");
  add_whole(
      app, "--seed", "N", {0}, [&options](long n) { options.seed = static_cast<unsigned long>(n); },
      "seed of random numbers, where any are drawn [1]");
  app.add_flag("--quiet", options.quiet, "print warnings only");
  app.add_flag("--verbose", options.verbose, "print all tables");
}

void add_sample_options(CLI::App& app, CommonOptions& options) {
  begin_group(app, "Filters and samples");
  SampleOptions& samples = options.samples;
  add_choice(
      app, "--torque-hold", "torque hold", {"auto", "zoh", "none"},
      [&samples](const std::string& name) { samples.torque_hold = torque_hold(name); },
      "whether tau is held until the next row (zoh) or is the mean around t (none)");
  add_number(
      app, "--cutoff", "HZ", {0}, [&samples](double hz) { samples.cutoff = hz; },
      "cut-off of the low-pass; 0: no filter");
  add_whole(
      app, "--filter-order", "N", {1, 10},
      [&samples](long n) { samples.filter_order = static_cast<int>(n); },
      "order of the Butterworth filter, run forward and backward [4]");
  add_whole(
      app, "--decimate", "N", {1, 100000},
      [&samples](long n) { samples.decimate = static_cast<int>(n); },
      "keep every N-th row, after a zero-phase FIR");
  add_whole(
      app, "--drop-edge", "N", {0}, [&samples](long n) { samples.drop_edge = n; },
      "rows dropped at both ends of each stretch");
  add_number(
      app, "--rest-speed", "RAD_S", {0}, [&samples](double v) { samples.rest_speed = v; },
      "rows slower than this are left out; 0: keep all");
}

bool wants_figures(const CommonOptions& options) {
  return std::any_of(options.reports.begin(), options.reports.end(),
                     [](const std::string& file) { return report_writer_for(file).figures; });
}

void add_choice_of_fit(CLI::App& app, std::string& model, std::string& preload,
                       const std::string& preload_default) {
  app.add_option("--model", model,
                 "which fit of a result [the only one, else poly, else the first]")
      ->type_name("NAME");
  app.add_option("--preload", preload,
                 fmt::format("which preload of a result [{}]", preload_default))
      ->type_name("NAME");
}

void add_sd_option(CLI::App& app, CommonOptions& options) {
  add_choice(
      app, "--sd", "kind of sd", {"honest", "white"},
      [&options](const std::string& kind) { options.robust_sd = kind == "honest"; },
      "white: the paper's (25) alone, the fastest");
}

std::vector<LogSurvey> read_logs(const CommonOptions& options) {
  const Progress progress(options.quiet, "reading logs");
  std::vector<LogSurvey> logs = cablefit::read_logs(
      options.logs, {options.rig, options.preload, options.reading, options.samples.threads});
  require_preload(logs, options.preload);
  return logs;
}

}  // namespace cablefit::apps
