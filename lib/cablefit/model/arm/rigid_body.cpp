#include "cablefit/model/arm/rigid_body.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

namespace cablefit {
namespace {

// Of the largest moment: URDFs often have three digits of each entry, and a thin plate has exactly
// the sum.
constexpr double kRounded = 0.01;

const char* const kAgain =
    "export the inertia about the centre of mass again, in kg m^2; CAD programs differ in the sign "
    "of ixy, ixz and iyz";

}  // namespace

BodyFault body_fault(const LinkInertia& body) {
  const double mass = body(0);
  if (mass < 0) return {fmt::format("a mass of {:.3g} kg", mass), "a mass is positive"};
  Eigen::Matrix3d tensor;
  tensor << body(4), body(5), body(6), body(5), body(7), body(8), body(6), body(8), body(9);
  if (mass == 0 && !tensor.isZero(0))
    return {fmt::format("an inertia of up to {:.3g} kg m^2, but a mass of 0",
                        tensor.cwiseAbs().maxCoeff()),
            "give it its mass, or leave out its <inertial>"};
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
  const double slack = kRounded * moments.cwiseAbs().maxCoeff();
  if (moments(0) < -slack)
    return {fmt::format("a negative principal moment of inertia, {:.3g} kg m^2", moments(0)),
            kAgain};
  if (moments(2) > moments(0) + moments(1) + slack)
    return {fmt::format("an impossible inertia: its largest principal moment, {:.3g} kg m^2, is "
                        "above the sum of the others, {:.3g} + {:.3g} kg m^2",
                        moments(2), moments(1), moments(0)),
            kAgain};
  return {};
}

}  // namespace cablefit
