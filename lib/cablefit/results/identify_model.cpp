// cablefit/identify/1 as a model: that of one preload.
#include <fmt/format.h>

#include "cablefit/base/quote.hpp"
#include "cablefit/results/result_models.hpp"

namespace cablefit::result_file {

Model read_identify_model(const JsonNode& root, const model_file::Wanted& wanted,
                          std::string* choice) {
  const JsonNode& preloads = root.at("preloads");
  const JsonNode& preload = pick(preloads, "name", wanted.preload, "");
  const std::string& name = preload.at("name").text();
  const JsonNode* node = preload.find("model");
  if (node == nullptr)
    throw preload.error(fmt::format("preload {} has no model", in_quotes(name)),
                        fmt::format("run `cablefit identify` again, or take the model_{}.json "
                                    "that it wrote beside this file",
                                    name));
  if (node->is_null())
    throw node->error(
        fmt::format("the dynamics of preload {} were not identified", in_quotes(name)),
        "run `cablefit identify` on moving logs with tau, and see what it says of them");
  Model model = model_file::read_model_file(*node, {"", wanted.model}, choice);
  *choice = fmt::format("{}, model '{}'",
                        describe(preloads, preload, "preload", "name", wanted.preload), model.name);
  return model;
}

}  // namespace cablefit::result_file
