#include "cablefit/model/file/identify_file.hpp"

#include <fmt/core.h>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/file/fit_parameters.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {
namespace {

const JsonNode& pick_preload(const JsonNode& preloads, const std::string& wanted) {
  if (wanted.empty()) return some_items(preloads).front();
  if (const JsonNode* found = find_item(preloads, "name", wanted)) return *found;
  std::vector<std::string_view> known;
  for (const JsonNode& item : preloads.items) known.push_back(item.at("name").text());
  fail_unknown(preloads, "preload", wanted, known);
}

/// "preload 'low' (of low, high)": the others when nobody had asked.
std::string describe(const JsonNode& preloads, const std::string& taken, bool was_asked_for) {
  const std::string text = fmt::format("preload {}", cablefit::quoted(taken));
  if (was_asked_for || preloads.items.size() < 2) return text;
  std::string all;
  for (const JsonNode& item : preloads.items)
    all += (all.empty() ? "" : ", ") + item.at("name").text();
  return fmt::format("{} (of {})", text, all);
}

}  // namespace

Model read_identify_file(const JsonNode& root, const Wanted& wanted, std::string* choice) {
  const JsonNode& preloads = root.at("preloads");
  const JsonNode& preload = pick_preload(preloads, wanted.preload);
  const std::string& name = preload.at("name").text();
  const JsonNode* node = preload.find("model");
  if (node == nullptr)
    throw preload.error(fmt::format("preload {} has no model", cablefit::quoted(name)),
                        fmt::format("run `cablefit identify` again, or take the model_{}.json "
                                    "that it wrote beside this file",
                                    name));
  if (node->is_null())
    throw node->error(
        fmt::format("the dynamics of preload {} were not identified", cablefit::quoted(name)),
        "run `cablefit identify` on moving logs with tau, and see what it says of them");
  Model model = read_model_file(*node, {"", wanted.model}, choice);
  *choice =
      fmt::format("{}, model '{}'", describe(preloads, name, !wanted.preload.empty()), model.name);
  return model;
}

}  // namespace cablefit::model_file
