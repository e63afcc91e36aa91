#include "cablefit/campaign/plan/campaign_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMaxPathBytes = 4096;
constexpr int kLeastDraws = 4, kMostDraws = 100'000;  // as of 'cablefit refine'
constexpr std::size_t kMaxDateBytes = 19;             // std::regex calls itself for every character

/// A log in two lists would count double, or judge what was made from it. One that has blocked and
/// moving parts belongs to both of these.
class NamedLogs {
 public:
  void add(const JsonNode& item, const std::string& path, const std::string& list) {
    const auto [same, is_new] = seen_.emplace(path, list);
    if (is_new) return;
    if (same->second == "blocked" && list == "moving") {
      same->second = list;
      return;
    }
    throw item.error(fmt::format("{} is already a log of '{}'", in_quotes(path), same->second),
                     "name each log of a cell once");
  }

 private:
  std::map<std::string, std::string> seen_;
};

std::vector<std::string> logs(const JsonNode& owner, std::string_view key,
                              const FindFiles& find_files, NamedLogs& named) {
  std::vector<std::string> paths;
  const JsonNode* list = owner.find(key);
  if (list == nullptr) return paths;
  if (!list->is_array())
    throw list->error(fmt::format("'{}' is not a list", list->path),
                      "write [\"low/blocked*.csv\"]");
  for (const JsonNode& item : list->items)
    for (std::string& path : matches(item, find_files)) {
      named.add(item, path, std::string(key));
      paths.push_back(std::move(path));
    }
  return paths;
}

/// The calendar is proleptic Gregorian, as in ISO 8601.
bool is_date(const std::string& text) {
  static const std::regex kForm(
      "(\\d{4})-(\\d\\d)-(\\d\\d)(T([01]\\d|2[0-3]):[0-5]\\d(:[0-5]\\d)?)?");
  std::smatch parts;
  if (text.size() > kMaxDateBytes || !std::regex_match(text, parts, kForm)) return false;
  const int year = std::stoi(parts[1]), month = std::stoi(parts[2]), day = std::stoi(parts[3]);
  if (month < 1 || month > 12 || day < 1) return false;
  const bool is_leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  const int n_days = month == 2                                              ? (is_leap ? 29 : 28)
                     : month == 4 || month == 6 || month == 9 || month == 11 ? 30
                                                                             : 31;
  return day <= n_days;
}

std::string read_date(const JsonNode& node) {
  if (is_date(node.text())) return node.text();
  throw node.error(fmt::format("'date' is {}, not a date", in_quotes(node.text())),
                   "write \"2026-03-14\" or \"2026-03-14T09:30\"");
}

std::size_t read_draws(const JsonNode& node) {
  const double n = node.number();
  if (n >= kLeastDraws && n <= kMostDraws && n == std::floor(n)) return static_cast<std::size_t>(n);
  throw node.error(fmt::format("'draws' is {}", n),
                   fmt::format("give a whole number from {} to {}", kLeastDraws, kMostDraws));
}

std::optional<CampaignRefine> read_refine(const JsonNode& node, const CampaignCell& cell,
                                          const FindFiles& find_files) {
  if (node.kind == JsonNode::Kind::boolean && !node.boolean()) return std::nullopt;
  CampaignRefine refine;
  if (!node.is_object() && node.kind != JsonNode::Kind::boolean)
    throw node.error("'refine' is neither true nor an object",
                     "write true, or {\"train\": [\"low/moving*.csv\"], \"test\": [..]}");
  if (node.is_object()) {
    node.allow_only({"train", "test", "draws"});
    if (const JsonNode* draws = node.find("draws")) refine.n_draws = read_draws(*draws);
    NamedLogs named;
    refine.train = logs(node, "train", find_files, named);
    refine.test = logs(node, "test", find_files, named);
  }
  if (!cell.moving.empty()) return refine;
  throw node.error("'refine' has no model to start from",
                   "give the cell 'moving' logs: stage 2 makes the model");
}

CampaignCell read_cell(const JsonNode& node, const FindFiles& find_files) {
  node.allow_only(
      {"name", "robot", "date", "rig", "preload", "blocked", "moving", "validation", "refine"});
  CampaignCell cell;
  if (const JsonNode* name = node.find("name")) cell.name = name->text();
  if (const JsonNode* robot = node.find("robot")) cell.robot = robot->text();
  if (const JsonNode* date = node.find("date")) cell.date = read_date(*date);
  if (const JsonNode* rig = node.find("rig")) cell.rig = matches(*rig, find_files).front();
  cell.preload = node.at("preload").text();
  NamedLogs named;
  cell.blocked = logs(node, "blocked", find_files, named);
  cell.moving = logs(node, "moving", find_files, named);
  cell.validation = logs(node, "validation", find_files, named);
  if (cell.blocked.empty())
    throw node.error("the cell has no blocked logs", "stage 1 needs a log with the link blocked");
  if (const JsonNode* refine = node.find("refine"))
    cell.refine = read_refine(*refine, cell, find_files);
  return cell;
}

std::string full_name(const CampaignCell& cell) {
  std::string name;
  for (const std::string* part : {&cell.robot, &cell.preload, &cell.date})
    if (!part->empty()) name += (name.empty() ? "" : ", ") + *part;
  return name;
}

void name_cells(std::vector<CampaignCell>& cells) {
  std::map<std::string, int> n_of_preload;
  for (const CampaignCell& cell : cells) ++n_of_preload[cell.preload];
  for (CampaignCell& cell : cells)
    if (cell.name.empty())
      cell.name = n_of_preload[cell.preload] == 1 ? cell.preload : full_name(cell);
}

}  // namespace

std::string beside(const std::string& campaign, const std::string& path) {
  const std::filesystem::path p(path);
  if (p.is_absolute()) return path;
  return (std::filesystem::path(campaign).parent_path() / p).lexically_normal().string();
}

std::vector<std::string> matches(const JsonNode& node, const FindFiles& find_files) {
  const std::string& named = node.text();
  // glob() calls itself for every folder of the pattern, and ends at a NUL.
  if (named.size() > kMaxPathBytes || named.find('\0') != std::string::npos)
    throw node.error(fmt::format("{} is not a path", in_quotes(named)),
                     "name a file, or a pattern as in \"low/moving*.csv\"");
  std::vector<std::string> paths = find_files(beside(node.place.file, named));
  if (!paths.empty()) return paths;
  throw node.error(fmt::format("no file matches {}", in_quotes(node.text())),
                   "paths are relative to the campaign file");
}

std::vector<CampaignCell> read_cells(const JsonNode& node, const FindFiles& find_files) {
  if (!node.is_array() || node.items.empty())
    throw node.error("'cells' is empty",
                     "a cell is {\"rig\", \"preload\", \"blocked\", \"moving\"}");
  std::vector<CampaignCell> cells;
  for (const JsonNode& item : node.items) cells.push_back(read_cell(item, find_files));
  name_cells(cells);
  std::set<std::string> seen;
  for (std::size_t k = 0; k < cells.size(); ++k)
    if (!seen.insert(cells[k].name).second)
      throw node.items[k].error(
          fmt::format("a second cell called {}", in_quotes(cells[k].name)),
          "give them a different \"date\", \"robot\" or \"name\", or merge them");
  return cells;
}

}  // namespace cablefit
