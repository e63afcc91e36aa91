#include "cablefit/results/read_model.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "cablefit/base/json/schemas.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/results/result_models.hpp"

namespace cablefit {
namespace {

using Reader = Model (*)(const JsonNode&, const model_file::Wanted&, std::string*);

constexpr std::array<std::pair<std::string_view, Reader>, 3> kReaders{
    {{kModelSchema, model_file::read_model_file},
     {kDynamicSchema, result_file::read_dynamic_model},
     {kIdentifySchema, result_file::read_identify_model}}};

}  // namespace

Model read_model(const std::string& path, const std::string& preload, const std::string& model,
                 std::string& choice) {
  return parse_model(read_json_file(path), preload, model, choice);
}

Model parse_model(const JsonNode& root, const std::string& preload, const std::string& model,
                  std::string& choice, Completeness completeness) {
  const JsonNode& schema = root.at("schema");
  for (const auto& [name, reader] : kReaders) {
    if (schema.text() == name) return reader(root, {preload, model, completeness}, &choice);
  }
  throw schema.error(fmt::format("schema {} is not a model", in_quotes(schema.text())),
                     fmt::format("expected '{}', or '{}' as `cablefit dynamic` writes it",
                                 kModelSchema, kDynamicSchema));
}

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
