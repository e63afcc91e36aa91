// Log files as every command reads them: each with its rig, then checked together.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

struct LogOptions {
  std::string rig;      ///< rig file; empty: rig.json beside each log, else the paper's rig
  std::string preload;  ///< name for logs that do not say theirs
  Reading reading = {};
  int threads = 1;
};

/// Checks units, signs and samples of all logs of a command together (weigh_logs()), then makes
/// channels of their loads where rig files differ in these alone (make_load_channels()).
void join_logs(std::vector<LogSurvey>& logs);

/// All logs, in the order given; of rig files that differ in their load alone, each with its load
/// as a channel. Throws one Error with what is wrong in any of them: files that cannot be read, a
/// log given twice, and what weigh_logs() says of units, signs and samples that cannot be right.
std::vector<LogSurvey> read_logs(const std::vector<std::string>& paths,
                                 const LogOptions& options = {});

/// The same with another way to read one log.
std::vector<LogSurvey> read_logs(const std::vector<std::string>& paths,
                                 const std::function<LogSurvey(const std::string&)>& read);

}  // namespace cablefit
