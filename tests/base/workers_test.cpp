// Pieces of work on several threads.
#include "cablefit/base/workers.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <set>
#include <stdexcept>

namespace cablefit {
namespace {

TEST_CASE("every piece is done once, whatever the number of threads") {
  for (const int threads : {1, 2, 7, 100}) {
    std::vector<std::atomic<int>> done(50);
    for_each_piece(threads, done.size(), [&](std::size_t k) { ++done[k]; });
    for (const auto& n : done) CHECK(n == 1);
  }
  for_each_piece(4, 0, [](std::size_t) { FAIL("there is nothing to do"); });
}

TEST_CASE("pieces run at the same time") {
  // Each waits for the other: with one thread neither would end.
  std::atomic<int> n_begun{0};
  std::set<std::thread::id> threads;
  std::mutex mutex;
  for_each_piece(2, 2, [&](std::size_t) {
    ++n_begun;
    while (n_begun < 2) std::this_thread::yield();
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  CHECK(threads.size() == 2);
}

TEST_CASE("an exception comes out, and no more pieces are begun") {
  for (const int threads : {1, 3}) {
    std::atomic<int> n_begun{0};
    const auto work = [&](std::size_t k) {
      ++n_begun;
      if (k == 5) throw std::runtime_error("five");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    CHECK_THROWS_WITH(for_each_piece(threads, 1000, work), "five");
    CHECK(n_begun < 1000);
  }
}

}  // namespace
}  // namespace cablefit
