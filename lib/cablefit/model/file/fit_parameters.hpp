// The parameters of one fit in a result file, by name. Internal to model/file.
#pragma once

#include <string_view>
#include <vector>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/model/rig.hpp"

namespace cablefit::model_file {

/// The item of a list of objects whose `key` is `value`, or nullptr.
const JsonNode* find_item(const JsonNode& list, std::string_view key, std::string_view value);

/// The fit's "parameters", and those of stage 1 in its "elastic" object. A one-step fit has no such
/// object and lists the elastic parameters among the others. Keeps track of what was asked for.
class FitParameters {
 public:
  explicit FitParameters(const JsonNode& fit);

  /// The "elastic" object, or nullptr.
  const JsonNode* elastic() const { return elastic_; }
  const JsonNode* find_dynamic(std::string_view name);
  const JsonNode* find_elastic(std::string_view name);
  const JsonNode& at_elastic(std::string_view name);
  /// Throws for a parameter that nobody asked for: it would silently be left out.
  void require_all_used() const;

 private:
  struct Entry {
    const JsonNode* node;
    bool is_used;
  };
  const JsonNode& fit_;
  const JsonNode* elastic_;
  std::vector<Entry> dynamic_;
};

}  // namespace cablefit::model_file
