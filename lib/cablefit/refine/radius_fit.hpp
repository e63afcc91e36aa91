// The base fits of all joints with another radius of one pulley. It changes the elongation of its
// cable in the equations of every joint that the cable passes. Internal to refine/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

/// A round pulley of the rig: of which cable, on which joint (both from 0), and on which side.
/// Radius 0: the rig file lets the cable pass the joint without moving it.
struct Pulley {
  std::size_t cable = 0;
  int joint = 0;
  Side side = Side::link;
};

/// Round pulleys on joints that turn, and links that the cable passes with radius 0. None where the
/// rig file gives no cables: radii are then 1 by definition. `model`: of all joints.
std::vector<Pulley> pulleys_of(const Model& model);
/// m, signed.
double radius_of(const Transmission& transmission, const Pulley& pulley);
void set_radius(Transmission& transmission, const Pulley& pulley, double radius);
/// Models of all joints with this radius (m, signed).
std::vector<Model> with_radius(std::vector<Model> models, const Pulley& pulley, double radius);

class RadiusFit {
 public:
  /// `models`: of all joints, one per preload. A joint without a base fit is left out.
  RadiusFit(const std::vector<Model>& models, const RefineLogs& logs);

  const Model& model() const { return models_.front(); }

  /// Squared residuals of the joints that the cable passes, one joint after the other, per block of
  /// time. Weights are those of the fits with the given radius. `change` (m) is added to the
  /// radius, and the linear parameters are fitted anew. Nothing where the rows do not determine
  /// them, or where no joint that the cable passes has a fit.
  struct Errors {
    Eigen::ArrayXd in_sample, held_out;  ///< held_out: the other blocks predict it; or empty
    double sum() const { return in_sample.sum(); }
  };
  std::optional<Errors> errors(const Pulley& pulley, double change, bool with_held_out) const;

 private:
  /// rad (m on a linear axis), of a stretch from the reference pose, smoothed.
  Eigen::ArrayXd travel(const Pulley& pulley, std::size_t stretch) const;
  BlockGrams grams(const BaseFit& base, const Pulley& pulley, double change) const;

  std::vector<Model> models_;
  std::vector<std::optional<BaseFit>> joints_;
};

}  // namespace cablefit
