// Rows that a program adds to the catalogue (add_effect); what such a row does:
// examples/own_effect.
#include <catch2/catch.hpp>

#include "cablefit/model/effects.hpp"

namespace {

using namespace cablefit;

void pull(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
          double* /*motor*/) {
  link[0] = state.q;
}

TEST_CASE("an effect of a program's own stands in the catalogue, once", "[model]") {
  static constexpr ParameterInfo kParameters[] = {{"stiffness", "k", "N m/rad", "of a spring", 0}};
  const Effect& stribeck = find_candidate("stribeck", Site::motor);
  const std::size_t n = candidate_effects().size();
  Effect row;
  row.name = "return_spring";
  row.site = Site::link;
  row.parameters = kParameters;
  row.torque = pull;
  add_effect(row);
  CHECK(candidate_effects().size() == n + 1);
  CHECK(find_candidate("return_spring", Site::link).torque == pull);
  CHECK(&find_candidate("stribeck", Site::motor) == &stribeck);  // models point to rows
  CHECK_THROWS_WITH(add_effect(row),
                    "effect 'return_spring' of the link exists; give yours another name");
}

TEST_CASE("an effect of a program's own is no base row and has one kind of functions", "[model]") {
  Effect row;
  row.name = "odd";
  row.site = Site::link;
  const std::size_t n = candidate_effects().size();
  CHECK_THROWS_WITH(add_effect(row),
                    "effect 'odd' has 0 kinds of functions; give torque or level (or both), or "
                    "correct, or change");
  row.torque = pull;
  row.site = Site::rigid;
  CHECK_THROWS_WITH(add_effect(row),
                    "effect 'odd' would be of the base model; leave `follows` alone; on a rigid "
                    "drive effects of the motor act");
  CHECK(candidate_effects().size() == n);
}

}  // namespace
