#include "output/result_files.hpp"

#include <filesystem>

#include "cablefit/results/write/identify_json.hpp"
#include "cablefit/results/write/refine_json.hpp"
#include "output/file_names.hpp"

namespace cablefit::apps {

std::vector<ResultFile> files_of(const IdentifyResult& result) {
  std::vector<ResultFile> files = {{"identify.json", identify_json(result)}};
  std::vector<std::string> preloads, contents;
  for (const IdentifyPreload& preload : result.preloads) {
    if (!preload.model) continue;
    preloads.push_back(preload.name);
    contents.push_back(model_json(*preload.model));
  }
  const std::vector<std::string> names = preload_file_names("model", preloads);
  for (std::size_t k = 0; k < names.size(); ++k) files.push_back({names[k], contents[k]});
  return files;
}

std::vector<std::string> names_by_preload(const std::string& stem,
                                          const std::vector<std::string>& preloads) {
  if (preloads.size() == 1) return {stem + ".json"};
  return preload_file_names(stem, preloads);
}

std::vector<std::string> model_file_names(const RefineResult& result) {
  std::vector<std::string> preloads;
  for (const Model& model : result.models) preloads.push_back(model.preload);
  return names_by_preload("refined", preloads);
}

std::vector<std::string> paths_below(const std::string& folder,
                                     const std::vector<std::string>& names) {
  std::vector<std::string> paths;
  for (const std::string& name : names)
    paths.push_back((std::filesystem::path(folder) / name).string());
  return paths;
}

std::vector<ResultFile> files_of(const RefineResult& result, const std::string& name,
                                 const std::vector<std::string>& model_names) {
  std::vector<ResultFile> files = {{name, refine_json(result, model_names)}};
  for (std::size_t k = 0; k < model_names.size(); ++k)
    files.push_back({model_names[k], model_json(result.models[k])});
  return files;
}

}  // namespace cablefit::apps
