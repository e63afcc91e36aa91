#include "cablefit/results/design_models.hpp"

#include <fmt/format.h>

#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/json/schemas.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/results/read_model.hpp"

namespace cablefit {
namespace {

bool is_rig(const JsonNode& root) {
  const JsonNode* schema = root.find("schema");
  if (schema != nullptr && schema->is_string()) return schema->text() == kRigSchema;
  return root.find("cables") != nullptr && root.find("transmission") == nullptr;
}

Model model_of_rig(const JsonNode& root, std::string& choice) {
  Model model;
  model.rig = parse_rig(root);
  model.preload = model.rig.preload;
  model.transmission = model.rig.transmission;
  if (!model.rig.cables_given)
    throw input_error(root.place, "a rig file without cables has no preload to design",
                      "give \"cables\" with \"coefficients\", or a model file or a result");
  for (std::size_t k = 0; k < model.transmission.cables.size(); ++k)
    if (model.transmission.cables[k].coefficients.empty())
      throw input_error(
          root.at("cables").items[k].place,
          fmt::format("cable {} has no coefficients", in_quotes(model.transmission.cables[k].name)),
          "give \"coefficients\": [N/m, N/m^2, ...], or a fitted model");
  const SearchedRadii searched = searched_radii(model.transmission);
  for (std::size_t k = 0; k < searched.size(); ++k)
    if (searched[k])
      throw input_error(root.at("cables").items[k].at("motor_radius").place,
                        fmt::format("the motor radius of cable {} is searched",
                                    in_quotes(model.transmission.cables[k].name)),
                        "give it in m, or the result of 'cablefit identify'");
  choice = fmt::format("the cables of rig {}", root.place.file);
  return model;
}

/// Of a result with fits of stage 2 or of one step; none of other files.
std::vector<std::string> names_of_preloads(const JsonNode& root) {
  const JsonNode* preloads = root.find("preloads");
  const JsonNode* schema = root.find("schema");
  const bool is_stage1 =
      schema != nullptr && schema->is_string() && schema->text() == kElasticSchema;
  std::vector<std::string> names;
  if (is_stage1 || preloads == nullptr || !preloads->is_array()) return names;
  for (const JsonNode& item : preloads->items) names.push_back(item.at("name").text());
  return names;
}

}  // namespace

Model read_design_model(const std::string& path, const std::string& preload,
                        const std::string& model, std::string& choice) {
  const JsonNode root = read_json_file(path);
  if (is_rig(root)) {
    if (!preload.empty() || !model.empty())
      throw usage_error(
          fmt::format("--{} does not apply to a rig file", preload.empty() ? "model" : "preload"),
          "leave it out, or give a result instead");
    return model_of_rig(root, choice);
  }
  Model found = parse_model(root, preload, model, choice);
  require_cables(found, path);
  return found;
}

void require_cables(const Model& model, const std::string& path) {
  if (model.rigid)
    throw input_error({path}, "a rigid drive has no cables to design",
                      "give a model of the elastic drive (--model poly)");
  if (model.transmission.cables.empty())
    throw input_error({path},
                      fmt::format("model {} is one spring, without cables", in_quotes(model.name)),
                      "choose one with cables, --model poly");
}

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

FittedPreloads other_preloads(const std::string& path, const std::string& model) {
  const JsonNode root = read_json_file(path);
  FittedPreloads found;
  for (const std::string& name : names_of_preloads(root)) {
    try {
      std::string choice;
      Model one = parse_model(root, name, model, choice, Completeness::as_it_is);
      require_cables(one, path);
      found.models.push_back(std::move(one));
    } catch (const Error& error) {
      found.left_out.push_back(fmt::format("{}: {}", name, error.what()));
    }
  }
  return found;
}

}  // namespace cablefit
