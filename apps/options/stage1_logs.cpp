#include "options/stage1_logs.hpp"

#include <filesystem>

#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/json/schemas.hpp"
#include "cablefit/campaign/compare/recorded_estimates.hpp"

namespace cablefit::apps {
namespace {

namespace fs = std::filesystem;

std::string schema_of(const JsonNode& root) {
  const JsonNode* schema = root.is_object() ? root.find("schema") : nullptr;
  return schema != nullptr && schema->is_string() ? schema->text() : "";
}

/// From the current folder, from that of the result, or from the one above, where the result was
/// made: OUT is a folder in it. Empty: at none of them.
std::string locate(const std::string& named, const std::string& inside) {
  std::error_code ignored;
  const fs::path folder = fs::path(inside).parent_path();
  for (const fs::path& path : {fs::path(named), folder / named, folder / ".." / named})
    if (fs::exists(path, ignored)) return path.lexically_normal().string();
  return "";
}

/// The input where it is still what it was; else why it is not.
std::string same_file(const JsonNode& input, const std::string& inside, std::string& why) {
  const std::string& named = input.at("path").text();
  const std::string path = locate(named, inside);
  if (path.empty()) {
    why = named + " is gone";
    return "";
  }
  if (sha256_of_file(path) == input.at("sha256").text()) return path;
  why = path + " has changed since then";
  return "";
}

void take_inputs(const JsonNode& root, const std::string& path, Stage1Logs& logs) {
  logs.source = path;
  const std::set<std::string> judged = validation_logs(root);
  for (const JsonNode& input : root.at("inputs").items) {
    const std::string& name = input.at("path").text();
    if (fs::path(name).extension() == ".json" && input.at("rows").number() == 0) continue;
    if (judged.contains(name)) continue;
    std::string why;
    std::string found = same_file(input, path, why);
    if (found.empty())
      logs.gone.push_back(why);
    else
      logs.paths.push_back(std::move(found));
  }
}

}  // namespace

Stage1Logs stage1_logs(const std::string& result_path) {
  Stage1Logs logs;
  const JsonNode root = read_json_file(result_path);
  const std::string schema = schema_of(root);
  if (schema == kElasticSchema || schema == kIdentifySchema) take_inputs(root, result_path, logs);
  if (schema != kDynamicSchema) return logs;
  for (const JsonNode& input : root.at("inputs").items) {
    if (input.at("rows").number() != 0) continue;  // a log
    std::string why;
    const std::string path = same_file(input, result_path, why);
    if (path.empty()) {
      if (fs::path(input.at("path").text()).extension() != ".json") continue;
      logs.source = result_path;
      logs.gone.push_back("stage 1, " + why);
      continue;
    }
    const JsonNode elastic = read_json_file(path);
    if (schema_of(elastic) == kElasticSchema) take_inputs(elastic, path, logs);
  }
  return logs;
}

Stage1Logs own_logs(const std::string& result_path) {
  Stage1Logs logs;
  const JsonNode root = read_json_file(result_path);
  if (root.find("inputs") != nullptr) take_inputs(root, result_path, logs);
  return logs;
}

std::vector<std::string> changed_logs(const std::string& result_path) {
  std::vector<std::string> changed;
  std::error_code ignored;
  const auto made = fs::last_write_time(result_path, ignored);
  const JsonNode root = read_json_file(result_path);
  const JsonNode* inputs = root.find("inputs");  // a file written by hand may name none
  if (inputs == nullptr) return changed;
  for (const JsonNode& input : inputs->items) {
    const std::string path = locate(input.at("path").text(), result_path);
    if (path.empty() || fs::last_write_time(path, ignored) <= made) continue;
    std::string why;
    if (same_file(input, result_path, why).empty()) changed.push_back(why);
  }
  return changed;
}

bool is_model(const std::string& path) {
  if (fs::path(path).extension() != ".json") return false;
  try {
    return schema_of(read_json_file(path)).starts_with("cablefit/");
  } catch (const Error&) {
    return false;
  }
}

}  // namespace cablefit::apps
