#include "cablefit/refine/verdict/regimes.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/rows/regime_variables.hpp"

namespace cablefit {
namespace {

constexpr int kCells = 12;
constexpr double kOverItsRows = 1.5;  // times its share of the rows

struct Point {
  double value, squared;
};

std::vector<Point> points_of(const Design& design, const Eigen::VectorXd& x, RowKind wanted,
                             const RegimeVariable& variable) {
  std::vector<Point> points;
  for (std::size_t s = 0; s < design.rows.size(); ++s)
    for (const KindRows& kind : design.rows[s].kinds) {
      if (kind.kind != wanted) continue;
      const Eigen::VectorXd residual = kind.response - kind.base * x;
      for (std::size_t i = 0; i < kind.at.size(); ++i) {
        const double r = residual(static_cast<Eigen::Index>(i));
        points.push_back({value_at(variable, design, s, wanted, kind.at[i]), r * r});
      }
    }
  return points;
}

void add_regimes(std::vector<Point> points, RowKind kind, const RegimeVariable& variable,
                 double floor, std::vector<Regime>& out) {
  if (points.empty()) return;
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.value < b.value; });
  double excess = 0;
  for (const Point& p : points) excess += p.squared - floor * floor;
  const auto n = static_cast<double>(points.size());
  if (!(excess > (kVisibleGap - 1) * n * floor * floor)) return;
  const double low = points.front().value, high = points.back().value;
  const int cells = variable.regime == "direction" ? 2 : kCells;
  if (!(high > low)) return;
  std::size_t next = 0;
  for (int c = 0; c < cells; ++c) {
    const double to = c + 1 == cells ? high : low + (c + 1) * (high - low) / cells;
    Regime r;
    double squares = 0, rows = 0;
    while (next < points.size() && (c + 1 == cells || points[next].value <= to)) {
      squares += points[next++].squared;
      ++rows;
    }
    if (rows == 0) continue;
    r.equation = to_string(kind);
    r.regime = variable.regime;
    r.variable = kind == RowKind::link ? variable.link : variable.motor;
    r.from = low + c * (high - low) / cells;
    r.to = to;
    r.share_of_squared_gap = (squares - rows * floor * floor) / excess;
    r.share_of_rows = rows / n;
    r.rms = std::sqrt(squares / rows);
    r.noise = floor;
    if (r.share_of_squared_gap > kToldShare &&
        r.share_of_squared_gap > kOverItsRows * r.share_of_rows)
      out.push_back(std::move(r));
  }
}

}  // namespace

std::vector<Regime> find_regimes(const Design& design, const Eigen::VectorXd& x,
                                 const KindLevels& floor) {
  std::vector<Regime> all;
  for (const RowKind kind : {RowKind::link, RowKind::motor, RowKind::blocked})
    for (const RegimeVariable& variable : regime_variables())
      add_regimes(points_of(design, x, kind, variable), kind, variable,
                  floor[static_cast<std::size_t>(kind)], all);
  std::stable_sort(all.begin(), all.end(), [](const Regime& a, const Regime& b) {
    return a.share_of_squared_gap / std::sqrt(a.share_of_rows) >
           b.share_of_squared_gap / std::sqrt(b.share_of_rows);
  });
  return all;
}

}  // namespace cablefit
