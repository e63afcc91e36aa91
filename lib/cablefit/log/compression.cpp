#include "cablefit/log/compression.hpp"

#include <fmt/format.h>

namespace cablefit {

Error truncated_error(const std::string& path, std::string_view compression, std::size_t n_good) {
  return input_error({path},
                     fmt::format("{} data ends early after {} good bytes", compression, n_good),
                     "copy the file again");
}

Error corrupt_error(const std::string& path, std::string_view compression, std::size_t n_good,
                    std::string_view reason) {
  return input_error(
      {path},
      fmt::format("{} data is corrupt after {} good bytes ({})", compression, n_good, reason),
      "copy the file again");
}

}  // namespace cablefit
