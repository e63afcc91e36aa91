// Independent pieces of work on several threads, whichever is free taking the next: for pieces of
// very different length, whose results have places of their own.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace cablefit {

/// work(k) for k = 0 .. n-1 on up to `threads` threads, in about that order. An exception comes out
/// here, of several the first one, after the pieces that were begun have ended; no more are begun.
template <class Work>
void for_each_piece(int threads, std::size_t n, Work work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto take_pieces = [&] {
    for (std::size_t k = next++; k < n; k = next++) {
      try {
        work(k);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = n;
      }
    }
  };
  std::vector<std::thread> others;
  for (int k = 1; k < threads && static_cast<std::size_t>(k) < n; ++k) {
    try {
      others.emplace_back(take_pieces);
    } catch (const std::system_error&) {  // the system has no thread left: fewer do the work
      break;
    }
  }
  take_pieces();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace cablefit
