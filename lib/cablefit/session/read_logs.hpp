// Reads log files for all commands: each log with its rig, then all are checked together.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

struct LogOptions {
  std::string rig;      ///< rig file; empty: rig.json beside each log, else the paper's rig
  std::string preload;  ///< name for logs that do not give theirs
  Reading reading = {};
  int threads = 1;
};

/// Checks units, signs and samples of all logs of a command together (weigh_logs()). Then turns
/// their loads into channels where rig files differ in the load alone (make_load_channels()).
void join_logs(std::vector<LogSurvey>& logs);

/// All logs, in the given order. Where rig files differ in their load alone, each log has its load
/// as a channel. Throws one Error that lists the problems of all logs: files that cannot be read, a
/// log given twice, and units, signs and samples that cannot be right (weigh_logs()).
std::vector<LogSurvey> read_logs(const std::vector<std::string>& paths,
                                 const LogOptions& options = {});

/// As above, with another function to read one log.
std::vector<LogSurvey> read_logs(const std::vector<std::string>& paths,
                                 const std::function<LogSurvey(const std::string&)>& read);

}  // namespace cablefit
