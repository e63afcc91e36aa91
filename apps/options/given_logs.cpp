#include "options/given_logs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <system_error>

#include "cablefit/base/error.hpp"

namespace cablefit::apps {

void require_distinct(std::span<const GivenLogs> given) {
  std::map<std::filesystem::path, std::string> option_of;
  for (const GivenLogs& logs : given)
    for (const std::string& path : logs.paths) {
      std::error_code ignored;  // reading says what is wrong with a path
      const auto whole =
          std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
      const auto [same, is_new] = option_of.emplace(whole, logs.option);
      if (is_new) continue;
      if (same->second == logs.option)
        throw usage_error(fmt::format("log {} is given twice", path),
                          "give it once: duplicate data make every sd too small");
      throw usage_error(
          fmt::format("log {} is given to {} and {}", path, same->second, logs.option),
          "give it to one of them");
    }
}

}  // namespace cablefit::apps
