#include "cablefit/campaign/campaign.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <filesystem>
#include <set>

#include "cablefit/base/json_document.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr std::string_view kSchema = "cablefit/campaign/1";
constexpr std::size_t kMaxPathBytes = 4096;

std::string beside(const std::string& campaign, const std::string& path) {
  const std::filesystem::path p(path);
  if (p.is_absolute()) return path;
  return (std::filesystem::path(campaign).parent_path() / p).lexically_normal().string();
}

std::vector<std::string> files_on_disk(const std::string& pattern) {
  glob_t found{};
  std::vector<std::string> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  return paths;
}

std::vector<std::string> matches(const JsonNode& node, const FindFiles& find_files) {
  const std::string& named = node.text();
  // glob() calls itself for every folder of the pattern, and ends at a NUL.
  if (named.size() > kMaxPathBytes || named.find('\0') != std::string::npos)
    throw node.error(fmt::format("{} is no path", cablefit::quoted(named)),
                     "name a file, or a pattern as in \"low/moving*.csv\"");
  std::vector<std::string> paths = find_files(beside(node.place.file, named));
  if (!paths.empty()) return paths;
  throw node.error(fmt::format("no file matches {}", cablefit::quoted(node.text())),
                   "paths are relative to the campaign file");
}

std::vector<std::string> logs(const JsonNode& cell, std::string_view key,
                              const FindFiles& find_files) {
  std::vector<std::string> paths;
  const JsonNode* list = cell.find(key);
  if (list == nullptr) return paths;
  if (!list->is_array())
    throw list->error(fmt::format("'{}' is no list", list->path), "write [\"low/blocked*.csv\"]");
  for (const JsonNode& item : list->items)
    for (std::string& path : matches(item, find_files)) paths.push_back(std::move(path));
  return paths;
}

CampaignCell read_cell(const JsonNode& node, const FindFiles& find_files) {
  node.allow_only({"rig", "preload", "blocked", "moving", "validation"});
  CampaignCell cell;
  if (const JsonNode* rig = node.find("rig")) cell.rig = matches(*rig, find_files).front();
  cell.preload = node.at("preload").text();
  cell.blocked = logs(node, "blocked", find_files);
  cell.moving = logs(node, "moving", find_files);
  cell.validation = logs(node, "validation", find_files);
  if (cell.blocked.empty())
    throw node.error("the cell has no blocked logs", "stage 1 needs a log with the link blocked");
  return cell;
}

CampaignLimits read_limits(const JsonNode& node, const FindFiles& find_files) {
  node.allow_only({"rsd_percent", "torque_error", "drift", "new_effect"});
  CampaignLimits limits;
  if (const JsonNode* rsd = node.find("rsd_percent")) limits.rsd_percent = rsd->positive();
  if (const JsonNode* error = node.find("torque_error")) limits.torque_error = error->positive();
  if (const JsonNode* effect = node.find("new_effect"); effect != nullptr && effect->boolean())
    throw effect->error("'new_effect' cannot be gated yet", "leave it out or write false");
  if (const JsonNode* drift = node.find("drift")) {
    drift->allow_only({"baseline", "percent"});
    limits.drift_baseline = matches(drift->at("baseline"), find_files).front();
    limits.drift_percent = drift->at("percent").positive();
  }
  return limits;
}

void read_models(const JsonNode& node, Campaign& campaign) {
  campaign.models.clear();
  for (const JsonNode& item : node.items) {
    const std::string& model = item.text();
    if (model != "linear" && model != "poly")
      throw item.error(fmt::format("unknown model {}", cablefit::quoted(model)),
                       "known: linear, poly");
    campaign.models.push_back(model);
  }
  if (campaign.models.empty())
    throw node.error("'models' is empty", "write [\"linear\", \"poly\"]");
}

}  // namespace

Campaign read_campaign(const std::string& path) {
  return parse_campaign(read_json_file(path), files_on_disk);
}

Campaign parse_campaign(const JsonNode& root, const FindFiles& find_files) {
  root.allow_only({"schema", "name", "cells", "models", "estimator", "limits"});
  const JsonNode& schema = root.at("schema");
  if (schema.text() != kSchema)
    throw schema.error(
        fmt::format("'schema' is {}, not a campaign", cablefit::quoted(schema.text())),
        fmt::format("a campaign file says \"{}\"", kSchema));
  Campaign campaign;
  campaign.path = root.place.file;
  if (const JsonNode* name = root.find("name")) campaign.name = name->text();
  if (const JsonNode* models = root.find("models")) read_models(*models, campaign);
  if (const JsonNode* estimator = root.find("estimator")) campaign.estimator = estimator->text();
  if (const JsonNode* limits = root.find("limits"))
    campaign.limits = read_limits(*limits, find_files);
  const JsonNode& cells = root.at("cells");
  if (!cells.is_array() || cells.items.empty())
    throw cells.error("'cells' is empty",
                      "a cell is {\"rig\", \"preload\", \"blocked\", \"moving\"}");
  std::set<std::string> seen;
  for (const JsonNode& node : cells.items) {
    campaign.cells.push_back(read_cell(node, find_files));
    const CampaignCell& cell = campaign.cells.back();
    if (!seen.insert(cell.preload).second)
      throw node.error(fmt::format("a second cell of preload {}", cablefit::quoted(cell.preload)),
                       "merge the two, or name the preloads differently");
  }
  return campaign;
}

}  // namespace cablefit
