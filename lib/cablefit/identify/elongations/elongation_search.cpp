#include "cablefit/identify/elongations/elongation_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cablefit/identify/equations/admissible_elongations.hpp"
#include "cablefit/identify/equations/equilibrium.hpp"

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

/// Cables of one job that act on each other and of which some l_o is searched.
struct Group {
  std::size_t job = 0;
  std::vector<std::size_t> cables;
};

std::vector<Group> searched_groups(const JointFit& fit) {
  std::vector<Group> groups;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j)
    for (std::vector<std::size_t>& cables : cable_groups(fit.jobs[j].transmission))
      if (std::any_of(cables.begin(), cables.end(),
                      [&](std::size_t c) { return fit.jobs[j].searched[c]; }))
        groups.push_back({j, std::move(cables)});
  return groups;
}

/// Puts the searched elongations of a group at a place of the grid.
void set_group(const JointFit& fit, const Group& group, double scale, Elongations& l_o) {
  for (const std::size_t c : group.cables)
    if (fit.jobs[group.job].searched[c])
      l_o[group.job](static_cast<Eigen::Index>(c)) = scale * search_reach(fit, group.job, c) / 2;
}

Elongations known_elongations(const JointFit& fit) {
  Elongations l_o;
  for (const PreloadJob& job : fit.jobs) l_o.push_back(elongations_of(job.transmission));
  return l_o;
}

/// Every searched cable taut wherever the logs went.
Elongations tight_elongations(const JointFit& fit) {
  Elongations tight = known_elongations(fit);
  for (const Group& group : searched_groups(fit)) set_group(fit, group, kGrid.back(), tight);
  return tight;
}

/// Rows of every group at every place of the grid, and the merit of a combination of places.
class Grid {
 public:
  Grid(JointFit& fit, double scale_all) : fit_(fit), groups_(searched_groups(fit)) {
    std::vector<Elongations> diagonal;
    for (const double scale : kGrid) {
      diagonal.push_back(known_elongations(fit));
      for (const Group& group : groups_) set_group(fit, group, scale_all * scale, diagonal.back());
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

  using Places = std::vector<std::size_t>;  ///< per group, into kGrid

  std::size_t n_groups() const { return groups_.size(); }
  Elongations elongations(const Places& places) const {
    Elongations l_o = points_.front().l_o;
    for (std::size_t g = 0; g < places.size(); ++g)
      for (const std::size_t c : groups_[g].cables) {
        const auto at = static_cast<Eigen::Index>(c);
        l_o[groups_[g].job](at) = points_[places[g]].l_o[groups_[g].job](at);
      }
    return l_o;
  }
  /// Without equilibrium: the elongations of a place do not balance.
  double merit(const Places& places) const {
    std::vector<std::vector<RowStatistics>> rows;
    for (std::size_t j = 0; j < fit_.jobs.size(); ++j) rows.push_back(rows_at(places, j));
    JointInput input{elongations(places), {}};
    for (const std::vector<RowStatistics>& job : rows) input.rows.push_back(&job);
    return solve(joint_problem(fit_.jobs, fit_.layout, input, fit_.weights, {false, {}}))
        .weighted_rss;
  }

 private:
  /// Of each equation those of the place of the group that acts on its joint: no other cable stands
  /// in it.
  std::vector<RowStatistics> rows_at(const Places& places, std::size_t job) const {
    std::vector<RowStatistics> rows = *points_.front().rows[job];
    for (std::size_t g = 0; g < places.size(); ++g) {
      if (groups_[g].job != job) continue;
      std::size_t e = 0;
      for (const JointRecord& record : fit_.jobs[job].records)
        for (const JointEquation& equation : record.equations) {
          if (acts_on(groups_[g], equation.joint)) rows[e] = (*points_[places[g]].rows[job])[e];
          ++e;
        }
    }
    return rows;
  }
  bool acts_on(const Group& group, int joint) const {
    return std::any_of(group.cables.begin(), group.cables.end(), [&](std::size_t c) {
      return fit_.jobs[group.job].transmission.cables[c].passes(static_cast<std::size_t>(joint));
    });
  }

  JointFit& fit_;
  std::vector<Group> groups_;
  std::vector<JointPoint> points_;
};

struct Ranked {
  double merit = 0;
  Grid::Places places;
};

/// Every combination where they are few, else coordinate descents from the diagonal.
std::vector<Ranked> rank_places(const Grid& grid) {
  std::vector<Ranked> ranked;
  std::size_t combinations = 1;
  for (std::size_t g = 0; g < grid.n_groups(); ++g)
    combinations = std::min(kMaxCombinations + 1, combinations * kGrid.size());
  if (combinations <= kMaxCombinations) {
    for (std::size_t i = 0; i < combinations; ++i) {
      Grid::Places places;
      std::size_t rest = i;
      for (std::size_t g = 0; g < grid.n_groups(); ++g) {
        places.push_back(rest % kGrid.size());
        rest /= kGrid.size();
      }
      ranked.push_back({grid.merit(places), places});
    }
    return ranked;
  }
  for (std::size_t i = 0; i < kGrid.size(); ++i) {
    Ranked best{kUnbounded, Grid::Places(grid.n_groups(), i)};
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (std::size_t g = 0; g < grid.n_groups(); ++g)
        for (std::size_t place = 0; place < kGrid.size(); ++place) {
          Ranked other = best;
          other.places[g] = place;
          other.merit = grid.merit(other.places);
          if (other.merit < best.merit) best = other;
        }
    ranked.push_back(best);
  }
  return ranked;
}

/// Of points that fit alike the one that determines least.
const JointPoint& least_certain_of(const JointFit& fit, const std::vector<JointPoint>& ends) {
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

/// How much longer all l_o of the group have to be for its cables to be tight; infinite where one
/// is slack.
double tight_factor(const JointFit& fit, const Group& group, const Eigen::VectorXd& l_o) {
  double factor = 1;
  for (const std::size_t c : group.cables) {
    const double own = l_o(static_cast<Eigen::Index>(c));
    const double tight = kGrid.back() * search_reach(fit, group.job, c) / 2;
    if (fit.jobs[group.job].searched[c])
      factor = own > 0 ? std::max(factor, tight / own) : kUnbounded;
  }
  return factor;
}

/// Makes a group tight. With one joint the coefficients of two cables always follow; those of
/// several joints are determined one by one, so that the tensions must balance with them as well.
void tighten(const JointFit& fit, const Group& group, const JointPoint& point, Elongations& l_o) {
  const PreloadJob& job = fit.jobs[group.job];
  Eigen::VectorXd& own = l_o[group.job];
  const double factor = tight_factor(fit, group, own);
  if (job.n_joints() == 1 || !std::isfinite(factor))
    set_group(fit, group, kGrid.back(), l_o);
  else
    for (const std::size_t c : group.cables)
      if (job.searched[c]) own(static_cast<Eigen::Index>(c)) *= factor;
  if (job.n_joints() > 1) restore_equilibrium(job, job.searched, point.solution.x, own);
}

/// The point with the cables of one group (by its number within a job) tight in every job.
JointPoint tightened(JointFit& fit, const JointPoint& point, std::size_t number) {
  Elongations l_o = point.l_o;
  std::vector<std::size_t> next(fit.jobs.size(), 0);
  for (const Group& group : searched_groups(fit))
    if (next[group.job]++ == number) tighten(fit, group, point, l_o);
  return evaluate(fit, {l_o}).front();
}

std::size_t most_groups(const JointFit& fit) {
  std::vector<std::size_t> n(fit.jobs.size(), 0);
  for (const Group& group : searched_groups(fit)) ++n[group.job];
  return *std::max_element(n.begin(), n.end());
}

}  // namespace

JointPoint least_certain(JointFit& fit, std::vector<JointPoint> ends) {
  for (std::size_t number = 0; number < most_groups(fit); ++number) {
    ends.push_back(tightened(fit, number == 0 ? best_of(ends) : ends.back(), number));
    ends.push_back(least_certain_of(fit, ends));
  }
  return ends.back();
}

JointPoint search_elongations(JointFit& fit, double grid_scale) {
  const Elongations known = known_elongations(fit);
  JointPoint start = evaluate(fit, {known}).front();  // gives the reach of every cable
  if (!fit.searches()) {
    const std::vector<double> variances = own_variances(fit, start);
    for (std::size_t e = 0; e < variances.size(); ++e)
      if (variances[e] > 0) fit.weights[e] = 1 / variances[e];
    return evaluate(fit, {known}).front();
  }
  const Grid grid(fit, grid_scale);
  std::vector<Ranked> ranked = rank_places(grid);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.merit < b.merit; });
  std::vector<ElongationStart> starts = {{tight_elongations(fit)}};
  for (const Ranked& r : ranked)
    if (starts.size() <= kStarts) starts.push_back({grid.elongations(r.places)});
  std::vector<JointPoint> ends = descend(fit, starts);
  ends.push_back(polish(fit, best_of(ends)));
  return least_certain(fit, ends);
}

}  // namespace cablefit
