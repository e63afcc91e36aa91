#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "cablefit/model/read_models.hpp"

namespace cablefit {
namespace {

bool has_preloads(const std::string& path) {
  const JsonNode root = read_json_file(path);
  const JsonNode* preloads = root.find("preloads");
  return preloads != nullptr && preloads->is_array();
}

}  // namespace

std::vector<Model> read_fitted_models(const std::vector<std::string>& paths,
                                      const std::string& model) {
  std::vector<Model> all;
  for (const std::string& path : paths) {
    std::string choice;
    for (Model& one : read_models(path, "", model, choice, Completeness::as_it_is)) {
      require_cables(one, path);
      all.push_back(std::move(one));
    }
  }
  return all;
}

std::vector<Model> other_preloads(const std::string& path, const std::string& model) try {
  if (!has_preloads(path)) return {};
  return read_fitted_models({path}, model);
} catch (const Error&) {
  return {};
}

}  // namespace cablefit
