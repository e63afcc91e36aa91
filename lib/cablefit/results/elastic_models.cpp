#include "cablefit/results/elastic_models.hpp"

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/json/schemas.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/results/read/elastic_reader.hpp"

namespace cablefit {
namespace {

constexpr std::string_view kPreferred = "poly";  // as of a result of stage 2

const ElasticFit& pick(const ElasticPreload& preload, const std::string& wanted,
                       const std::string& path) {
  if (!wanted.empty()) {
    if (const ElasticFit* fit = preload.find(wanted)) return *fit;
    throw input_error({path}, fmt::format("preload '{}' has no fit '{}'", preload.name, wanted),
                      "its fits are linear and poly");
  }
  const ElasticFit* fit = preload.find(std::string(kPreferred));
  return fit != nullptr ? *fit : preload.fits.front();
}

Model model_of(const ElasticPreload& preload, const ElasticFit& fit, const Rig& rig) {
  Model model;
  model.name = fit.model;
  model.preload = preload.name;
  model.rig = rig;
  model.transmission = fit.transmission;
  // What is written from the model has the radii as found.
  for (const ElasticFit& other : preload.fits)
    for (std::size_t c = 0; c < other.transmission.cables.size(); ++c)
      model.rig.transmission.cables[c].motor_map = other.transmission.cables[c].motor_map;
  model.elastic = fit.parameters;
  for (Eigen::Index k = 0; k < fit.covariance.rows(); ++k)
    model.covariance.parameters.push_back(fit.parameters[static_cast<std::size_t>(k)].name);
  model.covariance.matrix = fit.covariance;
  model.joints.resize(static_cast<std::size_t>(rig.n_joints()));
  return model;
}

}  // namespace

bool is_elastic_result(const std::string& path) {
  const JsonNode root = read_json_file(path);
  const JsonNode* schema = root.is_object() ? root.find("schema") : nullptr;
  return schema != nullptr && schema->is_string() && schema->text() == kElasticSchema;
}

std::vector<Model> read_elastic_models(const std::string& path, const std::string& preload,
                                       const std::string& model, std::string& choice) {
  const JsonNode root = read_json_file(path);
  const ElasticResult result = parse_elastic_result(root);
  std::vector<Model> models;
  choice.clear();
  for (std::size_t k = 0; k < result.preloads.size(); ++k) {
    const ElasticPreload& own = result.preloads[k];
    if (!preload.empty() && own.name != preload) continue;
    const JsonNode& node = root.at("preloads").items[k];
    const Rig rig = model_file::read_rig_reference(node.find("rig"));
    const ElasticFit& fit = pick(own, model, path);
    models.push_back(model_of(own, fit, rig));
    choice += fmt::format("{}stage 1, preload '{}', model '{}'", choice.empty() ? "" : "; ",
                          own.name, fit.model);
  }
  if (models.empty())
    throw input_error({path}, fmt::format("no preload '{}'", preload),
                      "leave --preload out, or name one of the file's");
  return models;
}

}  // namespace cablefit
