#include "cablefit/campaign/plan/found_logs.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/campaign/plan/folder_date.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLevels = 3;
constexpr std::size_t kMostSchemaBytes = std::size_t{1} << 20;  // of a rig or campaign file

bool looks_like_log(fs::path path) {
  constexpr std::array kEndings = {".csv", ".tsv", ".txt", ".json"};
  if (path.extension() == ".gz" || path.extension() == ".zst") path.replace_extension();
  const std::string ending = path.extension().string();
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

/// Rig, model and campaign files, and results.
bool has_schema(const fs::path& path) {
  if (path.extension() != ".json") return false;
  try {
    const JsonNode root = read_json_file(path.string(), kMostSchemaBytes);
    return root.find("schema") != nullptr || root.find("$schema") != nullptr;
  } catch (const Error&) {  // too long, or no object: the reader of logs reports that
    return false;
  }
}

bool holds_results(const fs::path& folder) {
  std::error_code ignored;
  return folder.filename().string().starts_with('.') ||
         fs::exists(folder / "elastic.json", ignored) || fs::exists(folder / "batch.json", ignored);
}

std::vector<fs::path> candidates(const std::string& folder) {
  std::vector<fs::path> paths;
  try {
    for (auto at = fs::recursive_directory_iterator(folder);
         at != fs::recursive_directory_iterator(); ++at) {
      if (at->is_directory()) {
        if (at.depth() + 1 >= kMostLevels || holds_results(at->path()))
          at.disable_recursion_pending();
      } else if (at->is_regular_file() && looks_like_log(at->path()) && !has_schema(at->path())) {
        paths.push_back(at->path());
      }
    }
  } catch (const fs::filesystem_error& failure) {
    throw input_error({folder, 0, 0}, failure.code().message(), "name a folder with logs");
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<std::string> column_names(const std::string& path) {
  std::vector<std::string> names;
  try {
    const auto log = open_log(path);
    for (const ColumnHeader& column : log->header().columns)
      names.push_back(column.unit.empty() ? column.name : column.name + " [" + column.unit + "]");
  } catch (const Error&) {  // its problem is reported already
  }
  return names;
}

/// Collects logs as they are looked at.
class Finder {
 public:
  Finder(fs::path folder, int threads) : folder_(std::move(folder)), threads_(threads) {}

  void look_at(const fs::path& path) {
    try {
      const Rig rig = rig_for_log(path.string(), "");
      add(path, rig, survey_log(plan_log(path.string(), rig), preload_of(path, rig), threads_));
    } catch (const Error& error) {
      std::string problem = error.what();
      problem = problem.substr(0, problem.find('\n'));
      found_.unread.push_back({relative(path), problem, column_names(path.string())});
      note_folder(path, "", found_.unread.back().columns);
    }
  }
  FoundLogs take() {
    for (auto& [key, cell] : cells_) found_.cells.push_back(std::move(cell));
    for (auto& [path, folder] : without_rig_) found_.without_rig.push_back(std::move(folder));
    return std::move(found_);
  }

 private:
  std::string relative(const fs::path& path) const {
    return path.lexically_relative(folder_).generic_string();
  }
  std::string preload_of(const fs::path& path, const Rig& rig) const {
    if (!rig.preload.empty()) return rig.preload;
    fs::path folder = fs::path(relative(path)).parent_path();
    if (date_of_folder(folder.filename().string())) folder = folder.parent_path();
    return folder.filename().empty() ? "default" : folder.filename().string();
  }
  std::string date_of(const fs::path& path) const {
    return date_of_folder(fs::path(relative(path)).parent_path().filename().string()).value_or("");
  }
  void add(const fs::path& path, const Rig& rig, const LogSurvey& log) {
    std::set<std::string> preloads;
    for (const PartSurvey& part : log.parts) {
      preloads.insert(part.preload);
      FoundCell& cell = cells_[{part.preload, date_of(path)}];
      cell.preload = part.preload;
      cell.date = date_of(path);
      if (!rig.path.empty()) cell.rig = relative(rig.path);
      auto& logs = part.phase == Phase::blocked ? cell.blocked : cell.moving;
      if (logs.empty() || logs.back() != relative(path)) logs.push_back(relative(path));
    }
    if (rig.path.empty())
      note_folder(path, preloads.size() == 1 ? *preloads.begin() : "", column_names(path.string()));
  }
  void note_folder(const fs::path& path, const std::string& preload,
                   const std::vector<std::string>& columns) {
    std::error_code ignored;
    if (fs::exists(path.parent_path() / "rig.json", ignored)) return;
    const std::string folder = relative(path.parent_path());
    const auto [place, is_new] =
        without_rig_.try_emplace(folder, FolderWithoutRig{folder, preload, columns});
    if (is_new) return;
    if (place->second.preload != preload) place->second.preload.clear();
    std::vector<std::string>& known = place->second.columns;
    for (const std::string& column : columns)
      if (std::find(known.begin(), known.end(), column) == known.end()) known.push_back(column);
  }

  fs::path folder_;
  int threads_;
  FoundLogs found_;
  std::map<std::pair<std::string, std::string>, FoundCell> cells_;  // by preload and date
  std::map<std::string, FolderWithoutRig> without_rig_;
};

}  // namespace

FoundLogs find_logs(const std::string& folder, int threads) {
  Finder finder(fs::path(folder).lexically_normal(), threads);
  for (const fs::path& path : candidates(folder)) finder.look_at(path.lexically_normal());
  return finder.take();
}

}  // namespace cablefit
