#include "cablefit/figure/regions.hpp"

#include <algorithm>
#include <utility>

namespace cablefit {
namespace {

using Place = std::pair<Eigen::Index, Eigen::Index>;

std::vector<Place> neighbours(const Eigen::ArrayXXi& grid, Place at) {
  std::vector<Place> all;
  for (Eigen::Index i = at.first - 1; i <= at.first + 1; ++i)
    for (Eigen::Index j = at.second - 1; j <= at.second + 1; ++j)
      if (i >= 0 && j >= 0 && i < grid.rows() && j < grid.cols() && Place{i, j} != at)
        all.emplace_back(i, j);
  return all;
}

/// Steps (of a chess king) to a node of another kind or beyond the edge.
Eigen::ArrayXXi depths(const Eigen::ArrayXXi& kinds) {
  Eigen::ArrayXXi depth = Eigen::ArrayXXi::Zero(kinds.rows(), kinds.cols());
  std::vector<Place> front;
  const auto take = [&](Place at, int steps) {
    depth(at.first, at.second) = steps;
    front.push_back(at);
  };
  for (Eigen::Index i = 0; i < kinds.rows(); ++i)
    for (Eigen::Index j = 0; j < kinds.cols(); ++j) {
      const std::vector<Place> near = neighbours(kinds, {i, j});
      if (near.size() < 8 || std::any_of(near.begin(), near.end(), [&](Place p) {
            return kinds(p.first, p.second) != kinds(i, j);
          }))
        take({i, j}, 1);
    }
  for (int steps = 2; !front.empty(); ++steps)
    for (const Place& at : std::exchange(front, {}))
      for (const Place& p : neighbours(kinds, at))
        if (depth(p.first, p.second) == 0) take(p, steps);
  return depth;
}

/// Sets the depth of a whole region to 0.
void strike_out(const Eigen::ArrayXXi& kinds, Place from, Eigen::ArrayXXi& depth) {
  std::vector<Place> front = {from};
  while (!front.empty()) {
    const Place at = front.back();
    front.pop_back();
    depth(at.first, at.second) = 0;
    for (const Place& p : neighbours(kinds, at))
      if (depth(p.first, p.second) > 0 &&
          kinds(p.first, p.second) == kinds(from.first, from.second))
        front.push_back(p);
  }
}

Place deepest(const Eigen::ArrayXXi& depth) {
  const auto aside = [&](Eigen::Index i, Eigen::Index j) {
    return std::max(std::abs(2 * i - depth.rows() + 1), std::abs(2 * j - depth.cols() + 1));
  };
  Place best{0, 0};
  for (Eigen::Index i = 0; i < depth.rows(); ++i)
    for (Eigen::Index j = 0; j < depth.cols(); ++j) {
      const int gain = depth(i, j) - depth(best.first, best.second);
      if (gain > 0 || (gain == 0 && aside(i, j) < aside(best.first, best.second))) best = {i, j};
    }
  return best;
}

}  // namespace

std::vector<Note> region_notes(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                               const Eigen::ArrayXXi& kinds, const std::vector<std::string>& names,
                               int least_depth) {
  std::vector<Note> notes;
  Eigen::ArrayXXi depth = depths(kinds);
  for (Place at = deepest(depth); depth(at.first, at.second) >= std::max(1, least_depth);
       at = deepest(depth)) {
    notes.push_back(
        {x(at.first), y(at.second), names[static_cast<std::size_t>(kinds(at.first, at.second))]});
    strike_out(kinds, at, depth);
  }
  return notes;
}

}  // namespace cablefit
