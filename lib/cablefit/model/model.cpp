#include "cablefit/model/model.hpp"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/file/identify_file.hpp"
#include "cablefit/model/file/parts.hpp"

namespace cablefit {
namespace {

using Reader = Model (*)(const JsonNode&, const model_file::Wanted&, std::string*);

constexpr std::array<std::pair<std::string_view, Reader>, 3> kReaders{
    {{model_file::kModelSchema, model_file::read_model_file},
     {model_file::kResultSchema, model_file::read_result_file},
     {model_file::kIdentifySchema, model_file::read_identify_file}}};

}  // namespace

std::string joint_parameter_name(std::string_view name, int joint, int n_joints) {
  return n_joints > 1 ? fmt::format("{}[{}]", name, joint) : std::string(name);
}

Estimate blank_estimate(const ParameterInfo& parameter, int joint, const Rig& rig) {
  Estimate estimate;
  estimate.name = joint_parameter_name(parameter.name, joint, rig.n_joints());
  estimate.symbol = parameter.symbol;
  estimate.unit = unit_on(rig, parameter.unit);
  return estimate;
}

std::vector<EffectInstance> base_instances(Side side, int joint, const Rig& rig,
                                           const FindEstimate& find) {
  std::vector<EffectInstance> instances;
  for (const Effect& effect : base_effects(side))
    if (std::optional<Estimate> e = find(blank_estimate(effect.parameters.front(), joint, rig)))
      instances.push_back({&effect, {std::move(*e)}});
  return instances;
}

std::string_view default_model_name(const Model& model) {
  if (model.rigid) return "rigid";
  return model.transmission.cables.empty() ? "linear" : "poly";
}

Model read_model(const std::string& path, const std::string& preload, const std::string& model,
                 std::string& choice) {
  return parse_model(read_json_file(path), preload, model, choice);
}

Model parse_model(const JsonNode& root, const std::string& preload, const std::string& model,
                  std::string& choice) {
  return parse_model(root, preload, model, choice, Completeness::can_move);
}

Model parse_model(const JsonNode& root, const std::string& preload, const std::string& model,
                  std::string& choice, Completeness completeness) {
  const JsonNode& schema = root.at("schema");
  for (const auto& [name, reader] : kReaders) {
    if (schema.text() == name) return reader(root, {preload, model, completeness}, &choice);
  }
  throw schema.error(fmt::format("schema {} is not a model", cablefit::quoted(schema.text())),
                     fmt::format("expected '{}', or '{}' as `cablefit dynamic` writes it",
                                 model_file::kModelSchema, model_file::kResultSchema));
}

}  // namespace cablefit
