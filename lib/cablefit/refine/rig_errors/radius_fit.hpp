// The base fits of all joints with other radii of some pulleys. Each changes the elongation of its
// cable in the equations of every joint that the cable passes. Internal to refine/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/rig_errors/common_columns.hpp"

namespace cablefit {

/// A round pulley of the rig: of which cable, on which joint (both from 0), and on which side.
/// Radius 0: the rig file lets the cable pass the joint without moving it.
struct Pulley {
  std::size_t cable = 0;
  int joint = 0;
  Side side = Side::link;
  bool operator==(const Pulley&) const = default;
};

/// Round pulleys on joints that turn, and links that the cable passes with radius 0. None where the
/// rig file gives no cables: radii are then 1 by definition. `model`: of all joints.
std::vector<Pulley> pulleys_of(const Model& model);
/// m, signed.
double radius_of(const Transmission& transmission, const Pulley& pulley);
/// m, of all pulleys of a cable.
double largest_radius(const Cable& cable);
void set_radius(Transmission& transmission, const Pulley& pulley, double radius);
/// Models of all joints with this radius (m, signed).
std::vector<Model> with_radius(std::vector<Model> models, const Pulley& pulley, double radius);

struct RadiusChange {
  Pulley pulley;
  double by = 0;  ///< m, added to the radius
};
using RadiusChanges = std::vector<RadiusChange>;

class RadiusFit {
 public:
  /// `models`: of all joints, one per preload. A joint without a base fit is left out.
  RadiusFit(const std::vector<Model>& models, const RefineLogs& logs);

  const Model& model() const { return models_.front(); }

  /// Whether the turn of the pulley's joint is known where its cable needs it.
  bool knows(const Pulley& pulley) const;

  /// Squared residuals of the joints that the cables pass, one joint after the other, per block of
  /// time. Weights are those of the fits with the given radii. The linear parameters are fitted
  /// anew. Nothing where the rows do not determine them, or where no joint that the cables pass has
  /// a fit.
  struct Errors {
    Eigen::ArrayXd in_sample, held_out;  ///< held_out: the other blocks predict it; or empty
    std::vector<std::size_t> joints;     ///< from 0
    double sum() const { return in_sample.sum(); }
  };
  std::optional<Errors> errors(const RadiusChanges& changes, bool with_held_out) const;

  /// Torque per metre of each of these radii, with the changed radii. Of the joints that one of
  /// them or of the changed ones concerns. Nothing as above.
  std::optional<CommonColumns> slopes(const RadiusChanges& changes,
                                      const std::vector<Pulley>& of) const;

 private:
  /// Of the joint's elastic columns, per stretch and kind of row.
  using Columns = std::vector<std::vector<ReplacedColumns>>;

  /// Whether the joint has a base fit and a cable that one of these pulleys is on.
  bool concerns(const RadiusChanges& changes, std::size_t joint) const;
  /// rad (m on a linear axis), of a stretch from the reference pose, smoothed. Empty: not known.
  Eigen::ArrayXd travel(const Pulley& pulley, std::size_t stretch) const;
  /// Nothing where the travel of another joint is not known.
  std::optional<Columns> columns(const BaseFit& base, const RadiusChanges& changes) const;

  std::vector<Model> models_;
  std::vector<std::optional<BaseFit>> joints_;
};

}  // namespace cablefit
