// A spill file returns the numbers as they were appended, from memory or from the file.
#include "cablefit/log/spill_file.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <vector>

namespace {

using cablefit::SpillFile;

TEST_CASE("a spill file gives back short and long runs of numbers") {
  SpillFile file;
  std::vector<double> expected, values;
  for (const std::size_t n : {3, 200000, 5, 70, 50000, 1, 4096, 4095, 131072, 2}) {
    values.clear();
    for (std::size_t i = 0; i < n; ++i)
      values.push_back(0.5 * static_cast<double>(expected.size() + i));
    file.append(values);
    expected.insert(expected.end(), values.begin(), values.end());
  }
  REQUIRE(file.size() == expected.size());
  std::vector<double> all(expected.size());
  file.read(0, all);
  CHECK(all == expected);
  std::vector<double> some(60000);
  for (const std::size_t first : {0UL, 150000UL, expected.size() - 60000}) {
    file.read(first, some);
    CHECK(std::equal(some.begin(), some.end(), expected.begin() + static_cast<long>(first)));
  }
}

}  // namespace
