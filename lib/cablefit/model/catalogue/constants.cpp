#include "cablefit/model/catalogue/rows.hpp"

namespace cablefit::rows {
namespace {

constexpr ParameterInfo kTorque[] = {{"torque", "c", "N m", "constant torque on the link"}};
constexpr ParameterInfo kHalfDifference[] = {
    {"half_difference", "a", "N m", "dry friction is f + a forwards, f - a backwards"}};

template <Site kSide>
void one(const JointState& /*state*/, const double* /*shape*/, const double* /*z*/, double* link,
         double* motor) {
  own<kSide>(link, motor)[0] = 1;
}

}  // namespace

Effect constant_torque() {
  return {.name = "constant_torque",
          .site = Site::link,
          .alias_class = "constant",
          .equation = "c",
          .signature =
              "a constant in the link equation, none in the motor equation; similar to "
              "asymmetric Coulomb friction, a wrong load zero, or a wrong stage 1",
          .experiment =
              "no log separates it from asymmetric Coulomb friction; two loads, and loads on "
              "both cables, separate it from the others",
          .source = "Fichera & Grossard 2017, Table 2 (the motor's offset)",
          .parameters = kTorque,
          .torque = one<Site::link>};
}

Effect asymmetric_coulomb(Site side) {
  constexpr TwoSides<std::string_view> kEquation{"a, beside f_s sgn(qd)",
                                                 "a, beside f_sm sgn(thetad)"};
  constexpr TwoSides<std::string_view> kSignature{
      "dry friction of the link differs between directions: the same law as Coulomb's plus a "
      "constant, at rest too",
      "dry friction of the motor differs between directions: the same law as Coulomb's plus the "
      "offset of the model"};
  return {.name = "asymmetric_coulomb",
          .site = side,
          .alias_class = "constant",
          .equation = kEquation.at(side),
          .signature = kSignature.at(side),
          .experiment = "none",
          .source = "Bittencourt et al. 2010",
          .parameters = kHalfDifference,
          .torque = side == Site::link ? one<Site::link> : one<Site::motor>};
}

}  // namespace cablefit::rows
