#include "cablefit/elastic/rows/elongation_range.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr double kFirstStep = 1e-9;  // rad, below the resolution of any encoder
constexpr double kLargestTurn = 7;   // rad: a turn, for cables that no motor stretches
constexpr int kHalvings = 45;
constexpr double kElongationRounding = 1e-12;  // of a range

/// Largest turn from `start` in this direction with all cables inside their ranges.
template <typename Inside>
double largest_turn(Inside inside, double direction) {
  double in = 0, out = kFirstStep;
  while (out < kLargestTurn && inside(direction * out)) {
    in = out;
    out *= 2;
  }
  if (out >= kLargestTurn) return in;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (in + out);
    (inside(direction * middle) ? in : out) = middle;
  }
  return in;
}

}  // namespace

void ElongationRange::include(const ElongationRange& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
}

void ElongationRange::include(const Eigen::Ref<const Eigen::VectorXd>& elongations) {
  if (elongations.size() > 0) include({elongations.minCoeff(), elongations.maxCoeff()});
}

double ElongationRange::reach() const { return std::max({0.0, -low, high}); }

std::vector<double> longest_of(std::span<const ElongationRange> ranges) {
  std::vector<double> longest;
  for (const ElongationRange& range : ranges) longest.push_back(range.high);
  return longest;
}

DeflectionRange reference_deflections(const Transmission& transmission,
                                      std::span<const ElongationRange> ranges) {
  assert(transmission.n_joints == 1 && ranges.size() == transmission.cables.size());
  const auto inside = [&](double turn) {
    for (std::size_t c = 0; c < ranges.size(); ++c) {
      const Cable& cable = transmission.cables[c];
      const double rounding = kElongationRounding * (ranges[c].high - ranges[c].low);
      const double l = elongation_at(transmission, cable, turn);
      if (l < std::min(ranges[c].low, cable.initial_elongation) - rounding ||
          l > std::max(ranges[c].high, cable.initial_elongation) + rounding)
        return false;
    }
    return true;
  };
  return {-largest_turn(inside, -1), largest_turn(inside, 1)};
}

}  // namespace cablefit
