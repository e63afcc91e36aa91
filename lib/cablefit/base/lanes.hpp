// Four doubles side by side for the hot loops, added up in an order of their own: the bits are the
// same whatever registers the machine has.
#pragma once

#include <cstddef>
#include <cstring>

namespace cablefit {

/// Two doubles side by side, which every 64-bit machine has registers for. (Four, left to the
/// compiler to split in two, go through memory with GCC 12.)
using Pair = double __attribute__((vector_size(16)));

inline constexpr std::ptrdiff_t kLanes = 4;

struct Lanes {
  Pair low{}, high{};

  void add_product(const Lanes& a, const Lanes& b) {
    low += a.low * b.low;
    high += a.high * b.high;
  }
  void operator+=(const Lanes& a) {
    low += a.low;
    high += a.high;
  }
  double sum() const { return (low[0] + low[1]) + (high[0] + high[1]); }
};

inline Lanes operator+(const Lanes& a, const Lanes& b) { return {a.low + b.low, a.high + b.high}; }
inline Lanes scaled(const Lanes& a, double factor) { return {a.low * factor, a.high * factor}; }

/// `p` need not be aligned.
inline Lanes load(const double* p) {
  Lanes lanes;
  std::memcpy(&lanes.low, p, sizeof lanes.low);
  std::memcpy(&lanes.high, p + 2, sizeof lanes.high);
  return lanes;
}

inline void store(const Lanes& lanes, double* p) {
  std::memcpy(p, &lanes.low, sizeof lanes.low);
  std::memcpy(p + 2, &lanes.high, sizeof lanes.high);
}

/// Lane by lane; without a branch.
inline Lanes least(const Lanes& a, const Lanes& b) {
  return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}
inline Lanes greatest(const Lanes& a, const Lanes& b) {
  return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}

inline Lanes all_lanes(double x) { return {Pair{x, x}, Pair{x, x}}; }

inline double dot(const double* a, const double* b, std::ptrdiff_t n) {
  Lanes lanes;
  std::ptrdiff_t i = 0;
  for (; i + kLanes <= n; i += kLanes) lanes.add_product(load(a + i), load(b + i));
  double rest = 0;
  for (; i < n; ++i) rest += a[i] * b[i];
  return lanes.sum() + rest;
}

}  // namespace cablefit
