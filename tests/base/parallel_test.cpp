// Any number of threads must give what one gives: results in order, and the same error.
#include "cablefit/base/parallel.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using cablefit::ordered_pipeline;

constexpr int kItems = 40;

/// What comes of the items; `bad_item` fails in map, the producer ends with an error at `bad_end`.
std::string outcome(int threads, int bad_item, int bad_end) {
  std::string reduced;
  try {
    ordered_pipeline<int>(
        threads,
        [&](auto emit) {
          for (int i = 0; i < kItems; ++i) {
            if (i == bad_end) throw std::runtime_error("end " + std::to_string(i));
            emit(int{i});
          }
        },
        [&](int item) {
          if (item == bad_item) throw std::runtime_error("item " + std::to_string(item));
          return item * item;
        },
        [&](int result) { reduced += std::to_string(result) + " "; });
  } catch (const std::runtime_error& error) {
    reduced += error.what();
  }
  return reduced;
}

TEST_CASE("any number of threads gives the same results and the same error", "[base]") {
  for (const int bad_item : {-1, 0, 17, 38, 39})
    for (const int bad_end : {-1, 18, 20, 39}) {
      const std::string one = outcome(1, bad_item, bad_end);
      for (const int threads : {2, 3, 8}) {
        INFO(threads << " threads");
        CHECK(outcome(threads, bad_item, bad_end) == one);
      }
    }
  CHECK(outcome(1, 17, 18).ends_with("256 item 17"));
}

/// The same of a list.
std::string outcome_of_list(int threads, const std::vector<int>& bad_items) {
  std::vector<int> items(kItems);
  std::iota(items.begin(), items.end(), 0);
  std::string all;
  try {
    const auto results = cablefit::parallel_map(threads, items, [&](int item) {
      if (std::find(bad_items.begin(), bad_items.end(), item) != bad_items.end())
        throw std::runtime_error("item " + std::to_string(item));
      return item * item;
    });
    for (const int result : results) all += std::to_string(result) + " ";
  } catch (const std::runtime_error& error) {
    all = error.what();
  }
  return all;
}

TEST_CASE("a list mapped by any number of threads gives the same", "[base]") {
  for (const std::vector<int>& bad : {std::vector<int>{}, {0}, {39}, {31, 17}}) {
    const std::string one = outcome_of_list(1, bad);
    for (const int threads : {2, 3, 80}) {
      INFO(threads << " threads");
      CHECK(outcome_of_list(threads, bad) == one);
    }
  }
  CHECK(outcome_of_list(2, {31, 17}) == "item 17");
  CHECK(cablefit::parallel_map(2, std::vector<int>{}, [](int item) { return item; }).empty());
}

}  // namespace
