#include "output/file_names.hpp"

#include <algorithm>
#include <cctype>

namespace cablefit::apps {
namespace {

constexpr std::size_t kLongestName = 80;  // of a preload in a file's name

}  // namespace

std::string safe_file_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-' && c != '_'; },
      '_');
  return name;
}

std::vector<std::string> preload_file_names(const std::string& stem,
                                            const std::vector<std::string>& preloads) {
  std::vector<std::string> names;
  for (const std::string& preload : preloads) {
    const std::string first = stem + '_' + safe_file_name(preload.substr(0, kLongestName));
    std::string name = first + ".json";
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i)
      name = first + '_' + std::to_string(i) + ".json";
    names.push_back(name);
  }
  return names;
}

}  // namespace cablefit::apps
