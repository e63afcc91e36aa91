#include "cablefit/session/read_logs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "cablefit/base/problems.hpp"
#include "cablefit/samples/load_channels.hpp"
#include "cablefit/samples/weigh/weigh.hpp"

namespace cablefit {
namespace {

void require_distinct(const std::vector<std::string>& logs) {
  std::set<std::string> seen;
  for (const std::string& log : logs) {
    std::error_code ignored;
    const auto path = std::filesystem::weakly_canonical(log, ignored).string();
    if (seen.insert(path).second) continue;
    throw usage_error(fmt::format("log {} is given twice", log),
                      "give it once: duplicate data make every sd too small");
  }
}

void require_file(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return;
  throw input_error(
      {path, 0, 0}, "a folder, not a log",
      fmt::format("name its files, e.g. {}/*.csv", path.substr(0, path.find_last_not_of('/') + 1)));
}

LogSurvey read_log(const std::string& path, const LogOptions& options) {
  const Rig rig = rig_for_log(path, options.rig);
  return survey_log(plan_log(path, rig, options.reading),
                    rig.preload.empty() ? options.preload : rig.preload, options.threads);
}

}  // namespace

void join_logs(std::vector<LogSurvey>& logs) {
  weigh_logs(logs);
  make_load_channels(logs);
}

std::vector<LogSurvey> read_logs(const std::vector<std::string>& paths, const LogOptions& options) {
  return read_logs(paths, [&](const std::string& path) { return read_log(path, options); });
}

std::vector<LogSurvey> read_logs(const std::vector<std::string>& paths,
                                 const std::function<LogSurvey(const std::string&)>& read) {
  if (paths.empty()) throw usage_error("no log given", "name one or more log files");
  require_distinct(paths);
  std::vector<LogSurvey> logs;
  Problems problems;
  for (const std::string& path : paths)
    problems.collect([&] {
      require_file(path);
      logs.push_back(read(path));
    });
  problems.throw_if_any();
  join_logs(logs);
  return logs;
}

}  // namespace cablefit
