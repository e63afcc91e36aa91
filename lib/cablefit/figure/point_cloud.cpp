#include "cablefit/figure/point_cloud.hpp"

#include <cmath>

namespace cablefit {

PointCloud::PointCloud(std::size_t n_x, std::size_t n_y)
    : n_x_(n_x), x_(n_x), y_(n_y), occupied_(n_x * n_y, false) {}

void PointCloud::add(double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  if (!x_.covers(x) || !y_.covers(y)) widen(x, y);
  const std::size_t k = cell(x, y);
  if (occupied_[k]) return;
  occupied_[k] = true;
  points_x_.push_back(x);
  points_y_.push_back(y);
}

void PointCloud::widen(double x, double y) {
  while (!x_.covers(x)) x_.widen(x);
  while (!y_.covers(y)) y_.widen(y);
  // The points that are there move to the wider cells; the first one in a cell stays.
  occupied_.assign(occupied_.size(), false);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_x_.size(); ++i) {
    const std::size_t k = cell(points_x_[i], points_y_[i]);
    if (occupied_[k]) continue;
    occupied_[k] = true;
    points_x_[kept] = points_x_[i];
    points_y_[kept++] = points_y_[i];
  }
  points_x_.resize(kept);
  points_y_.resize(kept);
}

void PointCloud::draw(Trace& trace) const {
  trace.x = points_x_;
  trace.y = points_y_;
}

}  // namespace cablefit
