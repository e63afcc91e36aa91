#include "commands/result_files.hpp"

#include "cablefit/report/json/identify_json.hpp"
#include "cablefit/report/json/refine_json.hpp"
#include "commands/file_names.hpp"

namespace cablefit::apps {
namespace {

std::vector<std::string> preloads_of(const RefineResult& result) {
  std::vector<std::string> preloads;
  for (const Model& model : result.models) preloads.push_back(model.preload);
  return preloads;
}

}  // namespace

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

std::vector<std::string> model_file_names(const RefineResult& result, bool beside_others) {
  if (result.models.size() == 1 && !beside_others) return {"refined.json"};
  return preload_file_names("refined", preloads_of(result));
}

std::vector<ResultFile> files_of(const RefineResult& result, bool beside_others) {
  const std::vector<std::string> names = model_file_names(result, beside_others);
  const std::string own =
      beside_others ? preload_file_names("refine", preloads_of(result)).front() : "refine.json";
  std::vector<ResultFile> files = {{own, refine_json(result, names)}};
  for (std::size_t k = 0; k < names.size(); ++k)
    files.push_back({names[k], model_json(result.models[k])});
  return files;
}

}  // namespace cablefit::apps
