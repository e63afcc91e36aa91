// g(theta) or h(q) of one cable (Fichera & Grossard 2017, (3)): the sum of one map per joint and of
// maps of two joints, with its derivatives. All that asks how far the joints pull a cable goes
// through here.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/model/pair_maps/pair_maps.hpp"
#include "cablefit/model/routing.hpp"

namespace cablefit {

/// A view; `angle(k)` below gives the angle of joint k (from 0).
class SideMaps {
 public:
  SideMaps(const std::vector<DisplacementMap>& own, const std::vector<PairMap>& pairs)
      : own_(&own), pairs_(&pairs) {}

  template <typename Angle>
  double displacement(const Angle& angle) const {
    double sum = 0;
    for (std::size_t k = 0; k < own_->size(); ++k) sum += (*own_)[k].displacement(angle(k));
    for (const PairMap& pair : *pairs_) sum += at(pair, angle).displacement;
    return sum;
  }

  /// d/d angle of a joint, m.
  template <typename Angle>
  double radius(std::size_t joint, const Angle& angle) const {
    double sum = (*own_)[joint].radius(angle(joint));
    for (const PairMap& pair : *pairs_)
      if (pair.passes(joint)) sum += at(pair, angle).radius(pair.place(joint));
    return sum;
  }

  /// Adds factor times the second derivatives, m/rad, to a matrix of joints x joints.
  template <typename Angle>
  void add_slopes(const Angle& angle, double factor, Eigen::Ref<Eigen::MatrixXd> sum) const {
    for (std::size_t k = 0; k < own_->size(); ++k)
      sum(index(k), index(k)) += factor * (*own_)[k].radius_slope(angle(k));
    for (const PairMap& pair : *pairs_) {
      const Eigen::Matrix2d slope = at(pair, angle).slope;
      for (const int i : {0, 1})
        for (const int j : {0, 1})
          sum(index(pair.joints[place(i)]), index(pair.joints[place(j)])) += factor * slope(i, j);
    }
  }

  /// The second derivative by the angle of one joint.
  template <typename Angle>
  double radius_slope(std::size_t joint, const Angle& angle) const {
    double sum = (*own_)[joint].radius_slope(angle(joint));
    for (const PairMap& pair : *pairs_)
      if (pair.passes(joint)) sum += at(pair, angle).slope(pair.place(joint), pair.place(joint));
    return sum;
  }

  /// The joint moves the cable on this side.
  bool passes(std::size_t joint) const {
    for (const PairMap& pair : *pairs_)
      if (pair.passes(joint)) return true;
    return !(*own_)[joint].is_zero();
  }

  /// Every pulley is round: the radii are the same in all poses.
  bool is_round() const {
    for (const DisplacementMap& map : *own_)
      if (!map.kind->constant_radius) return false;
    return pairs_->empty();
  }

 private:
  template <typename Angle>
  static PairValue at(const PairMap& pair, const Angle& angle) {
    return pair.at(angle(pair.joints[0]), angle(pair.joints[1]));
  }
  static Eigen::Index index(std::size_t k) { return static_cast<Eigen::Index>(k); }
  static std::size_t place(int k) { return static_cast<std::size_t>(k); }

  const std::vector<DisplacementMap>* own_;
  const std::vector<PairMap>* pairs_;
};

}  // namespace cablefit
