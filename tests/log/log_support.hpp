// Packing, and reading a whole log at once, for the tests of logs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/log/log_reader.hpp"

namespace cablefit::test {

std::string gzipped(std::string_view text);
std::string zstd_packed(std::string_view text);

/// All rows of some columns.
struct WholeLog {
  std::vector<std::vector<double>> numbers;
  std::vector<std::vector<std::string>> texts;
  std::vector<std::uint64_t> lines;
};

/// Selects columns by name and reads to the end.
WholeLog read_all(LogReader& reader, const std::vector<std::string>& numbers,
                  const std::vector<std::string>& texts = {});

}  // namespace cablefit::test
