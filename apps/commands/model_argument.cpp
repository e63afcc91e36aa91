#include "commands/model_argument.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "cablefit/base/error.hpp"

namespace cablefit::apps {
namespace {

bool is_json(const std::string& path) { return std::filesystem::path(path).extension() == ".json"; }

}  // namespace

std::string take_model_path(CommonOptions& options, const std::string& command) {
  std::vector<std::string>& given = options.logs;
  const std::string usual = (std::filesystem::path(options.out) / "dynamic.json").string();
  if (given.empty())
    throw usage_error("no model and no log given",
                      fmt::format("see 'cablefit {} --help'", command));
  if (is_json(given.front())) {
    const std::string model = given.front();
    given.erase(given.begin());
    return model;
  }
  std::error_code ignored;
  if (std::filesystem::exists(usual, ignored)) return usual;
  throw usage_error(fmt::format("no model given and no {}", usual),
                    "name a model file or a result of 'cablefit dynamic' before the logs");
}

void require_own_place(const std::string& path, const std::string& model,
                       const CommonOptions& options, const std::string& result_file) {
  if (path.empty()) return;
  if (path == "-") throw usage_error("--trajectories cannot be '-'", "give the name of a file");
  std::vector<std::string> others = options.logs;
  others.insert(others.end(), options.reports.begin(), options.reports.end());
  others.insert(others.end(), {model, options.rig, options.json,
                               (std::filesystem::path(options.out) / result_file).string()});
  const auto whole = [](const std::string& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file));
  };
  for (const std::string& other : others) {
    if (other.empty() || whole(other) != whole(path)) continue;
    throw usage_error(fmt::format("the trajectories would overwrite {}", other),
                      "choose another --trajectories");
  }
}

}  // namespace cablefit::apps
