// Which speeds a motion visits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace cablefit {

/// Speeds of any size in constant memory: bins of 4 % width, from 2^-40 to 2^24 rad/s.
class SpeedHistogram {
 public:
  void add(double speed) {
    fastest_ = std::max(fastest_, speed);
    const double place = kPerOctave * (std::log2(speed) - kLowest);
    counts_[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0))] += 1;
    total_ += 1;
  }
  double fastest() const { return fastest_; }
  int bands() const {
    std::array<double, kBands> share{};
    for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
      const double speed = std::exp2(kLowest + (static_cast<double>(bin) + 0.5) / kPerOctave);
      const double band = std::min(kBands - 1.0, kBands * speed / fastest_);
      share[static_cast<std::size_t>(band)] += counts_[bin] / total_;
    }
    return static_cast<int>(
        std::count_if(share.begin(), share.end(), [](double s) { return s >= kBandShare; }));
  }

 private:
  static constexpr int kBands = 10;
  static constexpr double kBandShare = 0.01;  // of the moving rows: a speed that really occurs
  static constexpr double kLowest = -40, kPerOctave = 17, kBins = 64 * kPerOctave;
  std::array<double, static_cast<std::size_t>(kBins)> counts_{};
  double fastest_ = 0, total_ = 0;
};

}  // namespace cablefit
