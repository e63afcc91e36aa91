#include "cablefit/identify/elongations/elongation_search.hpp"

#include <algorithm>
#include <array>

namespace cablefit {
namespace {

// Of the largest deflection; dense where preloads usually are, below 0 for a gap.
constexpr std::array kGrid = {0.0,  -0.3, -0.1, -0.03, 0.03, 0.07, 0.12,
                              0.18, 0.26, 0.36, 0.5,   0.7,  1.3};
constexpr std::size_t kMaxCombinations = 2500;  // of the grid over all preloads
constexpr std::size_t kStarts = 4;
constexpr int kSweeps = 3;
// Deviance within which a second explanation stands that leaves d parameters more open: 99.9 % of
// chi^2(d) is about 7 + 3.5 d. What a kink really shows is hundreds.
constexpr double kAmbiguous = 7, kAmbiguousPerParameter = 3.5;

/// A job's elongations at a place of the grid.
Eigen::VectorXd grid_elongations(const JointFit& fit, std::size_t job, double scale) {
  Eigen::VectorXd l_o = elongations_of(fit.jobs[job].transmission);
  for (std::size_t c = 0; c < fit.jobs[job].searched.size(); ++c)
    if (fit.jobs[job].searched[c])
      l_o(static_cast<Eigen::Index>(c)) = scale * search_reach(fit, job, c) / 2;
  return l_o;
}

/// Every searched cable taut wherever the logs went.
Elongations tight_elongations(const JointFit& fit) {
  Elongations tight;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    tight.push_back(grid_elongations(fit, j, kGrid.back()));
  return tight;
}

/// Rows of every job at every place of the grid, and the merit of a combination of places.
class Grid {
 public:
  Grid(JointFit& fit, double scale_all) : fit_(fit) {
    std::vector<Elongations> diagonal;
    for (const double scale : kGrid) {
      diagonal.emplace_back();
      for (std::size_t j = 0; j < fit.jobs.size(); ++j)
        diagonal.back().push_back(grid_elongations(fit, j, scale_all * scale));
    }
    points_ = evaluate(fit, diagonal);
    std::vector<double> best(fit.weights.size(), 0.0);
    for (const JointPoint& point : points_) {
      const std::vector<double> variances = own_variances(fit, point);
      for (std::size_t e = 0; e < variances.size(); ++e)
        if (variances[e] > 0) best[e] = std::max(best[e], 1 / variances[e]);
    }
    fit.weights = best;
  }

  using Places = std::vector<std::size_t>;  ///< per job, into kGrid

  JointPoint point(const Places& places) const {
    JointPoint point;
    for (std::size_t j = 0; j < places.size(); ++j) {
      point.l_o.push_back(points_[places[j]].l_o[j]);
      point.rows.push_back(points_[places[j]].rows[j]);
    }
    return point;
  }
  /// Without equilibrium: the two elongations of a place do not balance.
  double merit(const Places& places) const {
    return solve(joint_problem(fit_.jobs, fit_.layout, point(places).input(), fit_.weights,
                               {false, {}}))
        .weighted_rss;
  }
  std::size_t n_places(std::size_t job) const {
    const auto& searched = fit_.jobs[job].searched;
    return std::find(searched.begin(), searched.end(), true) != searched.end() ? kGrid.size() : 1;
  }

 private:
  JointFit& fit_;
  std::vector<JointPoint> points_;
};

struct Ranked {
  double merit = 0;
  Grid::Places places;
};

/// Every combination where they are few, else coordinate descents from the diagonal.
std::vector<Ranked> rank_places(const JointFit& fit, const Grid& grid) {
  std::vector<Ranked> ranked;
  std::size_t combinations = 1;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    combinations = std::min(kMaxCombinations + 1, combinations * grid.n_places(j));
  if (combinations <= kMaxCombinations) {
    for (std::size_t i = 0; i < combinations; ++i) {
      Grid::Places places;
      std::size_t rest = i;
      for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
        places.push_back(rest % grid.n_places(j));
        rest /= grid.n_places(j);
      }
      ranked.push_back({grid.merit(places), places});
    }
    return ranked;
  }
  for (std::size_t i = 0; i < kGrid.size(); ++i) {
    Ranked best{kUnbounded, {}};
    for (std::size_t j = 0; j < fit.jobs.size(); ++j)
      best.places.push_back(std::min(i, grid.n_places(j) - 1));
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (std::size_t j = 0; j < fit.jobs.size(); ++j)
        for (std::size_t place = 0; place < grid.n_places(j); ++place) {
          Ranked other = best;
          other.places[j] = place;
          other.merit = grid.merit(other.places);
          if (other.merit < best.merit) best = other;
        }
    ranked.push_back(best);
  }
  return ranked;
}

}  // namespace

JointPoint least_certain(JointFit& fit, std::vector<JointPoint> ends) {
  ends.push_back(evaluate(fit, {tight_elongations(fit)}).front());
  const JointPoint* chosen = &best_of(ends);
  const double best = chosen->merit();
  const Eigen::Index least = n_undetermined(fit, *chosen);
  Eigen::Index most = least;
  for (const JointPoint& end : ends) {
    const Eigen::Index unknown = n_undetermined(fit, end);
    const double more = static_cast<double>(unknown - least);
    if (unknown <= most || end.merit() > best + kAmbiguous + kAmbiguousPerParameter * more)
      continue;
    most = unknown;
    chosen = &end;
  }
  return *chosen;
}

JointPoint search_elongations(JointFit& fit, double grid_scale) {
  Elongations known;
  for (const PreloadJob& job : fit.jobs) known.push_back(elongations_of(job.transmission));
  JointPoint start = evaluate(fit, {known}).front();  // tells the deflections
  if (!fit.searches()) {
    const std::vector<double> variances = own_variances(fit, start);
    for (std::size_t e = 0; e < variances.size(); ++e)
      if (variances[e] > 0) fit.weights[e] = 1 / variances[e];
    return evaluate(fit, {known}).front();
  }
  const Grid grid(fit, grid_scale);
  std::vector<Ranked> ranked = rank_places(fit, grid);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.merit < b.merit; });
  std::vector<ElongationStart> starts = {{tight_elongations(fit)}};
  for (const Ranked& r : ranked)
    if (starts.size() <= kStarts) starts.push_back({grid.point(r.places).l_o});
  std::vector<JointPoint> ends = descend(fit, starts);
  ends.push_back(polish(fit, best_of(ends)));
  return least_certain(fit, ends);
}

}  // namespace cablefit
