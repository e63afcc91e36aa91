#include "cablefit/model/file/fit_parameters.hpp"

#include <fmt/core.h>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {

const JsonNode* find_item(const JsonNode& list, std::string_view key, std::string_view value) {
  for (const JsonNode& item : some_items(list)) {
    if (item.at(key).text() == value) return &item;
  }
  return nullptr;
}

FitParameters::FitParameters(const JsonNode& fit) : fit_(fit), elastic_(fit.find("elastic")) {
  if (elastic_ && elastic_->is_null()) elastic_ = nullptr;
  for (const JsonNode& item : some_items(fit.at("parameters"))) dynamic_.push_back({&item, false});
}

const JsonNode* FitParameters::find_dynamic(std::string_view name) {
  for (Entry& entry : dynamic_) {
    if (entry.node->at("name").text() != name) continue;
    entry.is_used = true;
    return entry.node;
  }
  return nullptr;
}

const JsonNode* FitParameters::find_elastic(std::string_view name) {
  if (!elastic_) return find_dynamic(name);
  return find_item(elastic_->at("parameters"), "name", name);
}

const JsonNode& FitParameters::at_elastic(std::string_view name) {
  if (const JsonNode* node = find_elastic(name)) return *node;
  throw fit_.error(fmt::format("parameter '{}' is missing", name),
                   elastic_ ? "the fit's \"elastic\" object needs it"
                            : "add the \"elastic\" object of stage 1 to the fit");
}

void FitParameters::require_all_used() const {
  for (const Entry& entry : dynamic_) {
    if (entry.is_used) continue;
    const std::string& name = entry.node->at("name").text();
    throw entry.node->error(
        fmt::format("parameter {} belongs to no effect", cablefit::quoted(name)),
        "see `cablefit list effects`");
  }
}

}  // namespace cablefit::model_file
