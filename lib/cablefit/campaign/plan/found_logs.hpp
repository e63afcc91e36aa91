// The logs of a folder, sorted into what a campaign calls cells: for `cablefit init`.
#pragma once

#include <string>
#include <vector>

namespace cablefit {

/// Logs of one preload. Paths relative to the folder that was searched.
struct FoundCell {
  std::string preload;
  std::string date;  ///< ISO 8601, of a folder called by a date; may be empty
  std::string rig;   ///< rig file beside the logs; empty: there is none
  std::vector<std::string> blocked, moving;
};

/// A file that looks like a log and could not be read as one.
struct UnreadLog {
  std::string path;
  std::string problem;               ///< one line
  std::vector<std::string> columns;  ///< of its header, when there is one
};

/// A folder with logs and without a rig file.
struct FolderWithoutRig {
  std::string path;                  ///< relative, "." for the folder that was searched
  std::string preload;               ///< of its logs; empty: several, given by a column
  std::vector<std::string> columns;  ///< of all its logs
};

struct FoundLogs {
  std::vector<FoundCell> cells;  ///< by preload and date; each log in one list, or in both
  std::vector<UnreadLog> unread;
  std::vector<FolderWithoutRig> without_rig;
};

/// Searches every .csv, .tsv, .txt and .json (also .gz, .zst) in the folder and up to three levels
/// below. JSON files with a "schema" are no logs, nor are the files in folders of cablefit's
/// results. The preload is that of a column, else of the rig file, else the folder's name. A folder
/// named by a date gives the date, and the folder above it gives the preload. Throws Error(input)
/// for a folder that cannot be listed.
FoundLogs find_logs(const std::string& folder, int threads);

}  // namespace cablefit
