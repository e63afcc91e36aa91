// The blocked logs that a model was made from: where they are still the same, they are used again.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cablefit::apps {

struct Stage1Logs {
  std::vector<std::string> paths;  ///< of those that are there, with the bytes they had
  std::string source;              ///< the result that names them: "cablefit-out/elastic.json"
  std::vector<std::string> gone;   ///< "low/blocked.csv is gone", "... has changed since then"
};

/// Logs of stage 1 behind a result: those of the elastic.json that a result of `dynamic` names (if
/// it is still the same), those of a result of `elastic` or `identify` itself. Model files name
/// none. Paths are from the current folder, else from the folder of the result or the one above.
Stage1Logs stage1_logs(const std::string& result_path);

/// All logs that a result was fitted to, without those that it was only validated on; a model file
/// names none.
Stage1Logs own_logs(const std::string& result_path);

/// "low/blocked.csv has changed since then" of logs of a result of `elastic` that were written to
/// after it. Logs that are gone, or older than the result, are not read.
std::vector<std::string> changed_logs(const std::string& result_path);

/// A model file or a result, by its "schema"; a log is neither. False for what cannot be read as
/// JSON: reading it as a log says why.
bool is_model(const std::string& path);

}  // namespace cablefit::apps
