// Where the gap is, by frequency.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/rows/residual_spectrum.hpp"
#include "cablefit/refine/verdict/regimes.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kBandLags = 96;
constexpr Eigen::Index kBands = 48;
constexpr double kBandStandsOut = 4;   // times the floor's power there
constexpr std::size_t kMostBands = 2;  // per equation

/// Neighbouring bands that stand out of the floor, as one.
struct Run {
  Eigen::Index first = 0, last = 0;
  double gap = 0, floor = 0;  ///< (N m)^2
};

std::vector<Run> runs_above(const Spectrum& gap, const Spectrum& floor) {
  const Eigen::ArrayXd above = gap.power - floor.power;
  const double peak = above.maxCoeff();
  std::vector<Run> runs;
  bool inside = false;
  for (Eigen::Index b = 0; b < above.size(); ++b) {
    constexpr double kOfPeak = 0.1;
    const bool stands = above(b) > kOfPeak * peak && gap.power(b) > kBandStandsOut * floor.power(b);
    if (stands && !inside) runs.push_back({b, b, 0, 0});
    if (stands) {
      runs.back().last = b;
      runs.back().gap += gap.power(b);
      runs.back().floor += floor.power(b);
    }
    inside = stands;
  }
  return runs;
}

void add_bands(const ResidualMemory& seen, const ResidualMemory& noise, RowKind kind,
               std::vector<Regime>& out) {
  if (!(seen.period > 0) || !(noise.period > 0)) return;
  const double excess = seen.covariance(0) - noise.covariance(0);
  if (!(excess > (kVisibleGap - 1) * noise.covariance(0))) return;
  const Spectrum gap = spectrum_of(seen, kBands), floor = spectrum_of(noise, kBands);
  std::vector<Run> runs = runs_above(gap, floor);
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run& a, const Run& b) { return a.gap - a.floor > b.gap - b.floor; });
  if (runs.size() > kMostBands) runs.resize(kMostBands);
  for (const Run& run : runs) {
    Regime r;
    r.equation = to_string(kind);
    r.regime = "frequency";
    r.variable = "Hz";
    r.from = gap.width * static_cast<double>(run.first);
    r.to = gap.width * static_cast<double>(run.last + 1);
    r.share_of_squared_gap = (run.gap - run.floor) / excess;
    r.share_of_rows = static_cast<double>(run.last + 1 - run.first) / static_cast<double>(kBands);
    r.rms = std::sqrt(run.gap);
    r.noise = std::sqrt(run.floor);
    if (r.share_of_squared_gap > kToldShare) out.push_back(std::move(r));
  }
}

}  // namespace

std::vector<Regime> find_bands(const Design& design, const Eigen::VectorXd& x, const Design& floor,
                               const Eigen::VectorXd& x_floor) {
  std::vector<Regime> all;
  for (const RowKind kind : {RowKind::link, RowKind::motor, RowKind::blocked})
    add_bands(residual_memory(design, x, kind, kBandLags),
              residual_memory(floor, x_floor, kind, kBandLags), kind, all);
  return all;
}

std::vector<Regime> ranked(std::vector<Regime> cells, std::vector<Regime> bands,
                           const Design& design, const Eigen::VectorXd& x,
                           const KindLevels& floor) {
  constexpr std::size_t kMost = 10;
  std::map<std::string, double, std::less<>> in_floors;  // squared gap of each equation
  for (const StretchRows& stretch : design.rows)
    for (const KindRows& kind : stretch.kinds) {
      const double level = floor[static_cast<std::size_t>(kind.kind)];
      const auto n = static_cast<double>(kind.response.size());
      in_floors[std::string(to_string(kind.kind))] +=
          (kind.response - kind.base * x).squaredNorm() / (level * level) - n;
    }
  const auto weight = [&](const Regime& r) {
    // That a gap is slow says little: it stands last.
    if (r.regime == "frequency" && r.from == 0) return 1e-9 * in_floors[r.equation];
    return in_floors[r.equation] * r.share_of_squared_gap / std::sqrt(r.share_of_rows);
  };
  cells.insert(cells.end(), bands.begin(), bands.end());
  std::stable_sort(cells.begin(), cells.end(),
                   [&](const Regime& a, const Regime& b) { return weight(a) > weight(b); });
  if (cells.size() > kMost) cells.resize(kMost);
  return cells;
}

}  // namespace cablefit
