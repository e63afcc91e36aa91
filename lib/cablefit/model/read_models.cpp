#include "cablefit/model/read_models.hpp"

#include "cablefit/base/json/json_document.hpp"

namespace cablefit {

std::vector<Model> read_models(const std::string& path, const std::string& preload,
                               const std::string& model, std::string& choice,
                               Completeness completeness) {
  const JsonNode root = read_json_file(path);
  const JsonNode* preloads = root.find("preloads");
  std::vector<std::string> wanted = {preload};
  if (preload.empty() && preloads != nullptr && preloads->is_array() && !preloads->items.empty()) {
    wanted.clear();
    for (const JsonNode& item : preloads->items) wanted.push_back(item.at("name").text());
  }
  std::vector<Model> models;
  choice.clear();
  for (const std::string& name : wanted) {
    std::string taken;
    models.push_back(parse_model(root, name, model, taken, completeness));
    choice += (choice.empty() ? "" : "; ") + taken;
  }
  return models;
}

}  // namespace cablefit
