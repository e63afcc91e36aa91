// Random numbers that are the same with every standard library: the engine of <random> is specified
// bit by bit, its distributions are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace cablefit {

class Random {
 public:
  /// `purpose`: an independent stream of the same seed.
  explicit Random(std::uint64_t seed, std::uint64_t purpose = 0)
      : engine_(seed * 0x9E3779B97F4A7C15ULL + purpose) {}

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  /// Standard normal, polar method (Marsaglia & Bray 1964).
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double u = 0, v = 0, s = 0;
    do {
      u = 2 * uniform() - 1;
      v = 2 * uniform() - 1;
      s = u * u + v * v;
    } while (s >= 1 || s == 0);
    const double scale = std::sqrt(-2 * std::log(s) / s);
    spare_ = v * scale;
    has_spare_ = true;
    return u * scale;
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace cablefit
