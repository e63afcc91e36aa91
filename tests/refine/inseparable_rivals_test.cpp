// Which effects stand beside the identified one because the logs do not separate them.
#include "cablefit/refine/verdict/inseparable_rivals.hpp"

#include <catch2/catch.hpp>

using namespace cablefit;

namespace {

Rival candidate(const std::string& name, const std::string& side, double gain) {
  Rival c;
  c.name = name;
  c.side = side;
  c.gain = gain;
  return c;
}

/// A constant torque was identified in a gap of `rho` squared floors; a load scale closes 8 % of
/// it less and is in one group with it, a gravity imbalance closes as much and is in none.
std::vector<Rival> rivals(double rho, double less, bool from_base, bool is_alias = false) {
  RefineResult result;
  NamedEffect named;
  named.instance.effect = &find_candidate("constant_torque", Site::link);
  named.evidence.rho_before = rho;
  result.effects = {named};
  result.ranking = {candidate("constant_torque", "link", 1),
                    candidate("gravity_imbalance", "link", 1),
                    candidate("load_scale", "link", 1 - less)};
  NotSeparable group;
  group.effects = {"constant_torque (link)", "load_scale (link)"};
  group.from_base = from_base;
  group.is_alias = is_alias;
  result.not_separable = {group};
  add_inseparable_rivals(result);
  add_inseparable_rivals(result);  // nobody twice
  return result.effects[0].rivals;
}

}  // namespace

TEST_CASE("what the logs do not separate is listed where it closes nearly as much", "[refine]") {
  const std::vector<Rival> listed = rivals(10, 0.08, false);
  REQUIRE(listed.size() == 1);
  CHECK(listed[0].name == "load_scale");
  CHECK(rivals(10, 0.12, false).empty());
  CHECK(rivals(1.5, 0.12, false).size() == 1);  // a tenth of the floor is a fifth of that gap
}

TEST_CASE("beside an effect that is nearly in the model all are listed that close as much",
          "[refine]") {
  const std::vector<Rival> listed = rivals(10, 0.08, true);
  REQUIRE(listed.size() == 2);
  CHECK(listed[0].name == "gravity_imbalance");
  CHECK(listed[1].name == "load_scale");
  CHECK(rivals(10, 0.12, true).size() == 1);
  CHECK(rivals(10, 0.08, true, true).empty());  // aliases are not separable by rule
}
