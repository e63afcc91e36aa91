// Parallel work with results in order: the same bits for any number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <future>
#include <utility>
#include <vector>

namespace cablefit {

/// `produce(emit)` runs on the calling thread and hands items to emit(item) -> bool (false: stop).
/// `map(item)` runs on up to `threads` other threads (inline when threads <= 1) and must not touch
/// shared state. `reduce(result)` runs on the calling thread in the order of production. An
/// exception from any of them is thrown here after the running tasks have ended. Of several
/// exceptions, the one that a single thread would meet first is thrown.
template <class Item, class Produce, class Map, class Reduce>
void ordered_pipeline(int threads, Produce produce, Map map, Reduce reduce) {
  using Result = decltype(map(std::declval<Item>()));
  if (threads <= 1) {
    produce([&](Item&& item) {
      reduce(map(std::move(item)));
      return true;
    });
    return;
  }
  std::deque<std::future<Result>> running;
  const auto depth = static_cast<std::size_t>(threads);
  bool in_reduce = false;
  const auto reduce_first = [&] {
    in_reduce = true;
    Result result = running.front().get();
    running.pop_front();
    reduce(std::move(result));
    in_reduce = false;
  };
  // Where the system has no thread left, get() does the work.
  constexpr auto kPolicy = std::launch::async | std::launch::deferred;
  try {
    produce([&](Item&& item) {
      while (running.size() >= depth) reduce_first();
      running.push_back(std::async(
          kPolicy, [&map, item = std::move(item)]() mutable { return map(std::move(item)); }));
      return true;
    });
  } catch (...) {
    // Items produced earlier come first. They may throw an error of their own.
    while (!in_reduce && !running.empty()) reduce_first();
    throw;
  }
  while (!running.empty()) reduce_first();
}

/// {map(items[0]), map(items[1]), ...} on up to `threads` threads (inline when threads <= 1). Each
/// thread takes the next item when it is free, so items may differ in duration. Of several
/// exceptions, that of the first item is thrown after all threads have ended.
template <class Item, class Map>
auto parallel_map(int threads, const std::vector<Item>& items, Map map) {
  using Result = decltype(map(items.front()));
  std::vector<Result> results(items.size());
  std::vector<std::exception_ptr> failures(items.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < items.size(); k = next++) try {
        results[k] = map(items[k]);
      } catch (...) {
        failures[k] = std::current_exception();
      }
  };
  std::vector<std::future<void>> others;
  const auto most = std::min(items.size(), static_cast<std::size_t>(std::max(1, threads)));
  // Where the system has no thread left, get() does the work.
  for (std::size_t k = 1; k < most; ++k)
    others.push_back(std::async(std::launch::async | std::launch::deferred, work));
  work();
  for (std::future<void>& other : others) other.get();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return results;
}

}  // namespace cablefit
