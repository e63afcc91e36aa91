// Names of result files that carry a preload's name.
#pragma once

#include <string>
#include <vector>

namespace cablefit::apps {

/// What a file's name should not have becomes "_".
std::string safe_file_name(std::string name);

/// "model_low.json" for each preload; names that are taken are numbered: "model_a_b_2.json".
std::vector<std::string> preload_file_names(const std::string& stem,
                                            const std::vector<std::string>& preloads);

}  // namespace cablefit::apps
