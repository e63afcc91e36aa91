// One law has one size everywhere; what stands for another effect has not.
#include "cablefit/refine/verdict/agreement.hpp"

#include <catch2/catch.hpp>

#include "cablefit/refine/null/null_draws.hpp"
#include "tests/refine/hidden_logs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kBlockSeconds = 2;

/// Of the plain form of an effect, fitted to logs that hide `hidden`.
std::string disagreement(const std::string& hidden, std::string_view name, Site site) {
  const HiddenLogs logs = hidden_logs({hidden});
  std::vector<LogSurvey> all = logs.logs.blocked;
  all.insert(all.end(), logs.logs.train.begin(), logs.logs.train.end());
  const BaseFit base =
      fit_base(make_design(logs.models,
                           read_stretches(all, logs.models, [](const PartSurvey&) { return true; }),
                           smoothing_for(1e-3)),
               kBlockSeconds, nullptr);
  const Design with =
      with_variant(base.design, {&find_candidate(name, site), {}, 0, 0, true}, base.fit.x);
  const auto fit = fit_blocks(block_grams(with, kBlockSeconds), base.levels, false);
  REQUIRE(fit);
  return why_not_one_law(with, fit->x, base.levels, with.added.size() - 1, kBlockSeconds);
}

TEST_CASE("what is hidden has one size everywhere", "[refine]") {
  CHECK(disagreement("gravity_imbalance.link=1", "gravity_imbalance", Site::link).empty());
  CHECK(disagreement("constant_torque.link=1", "constant_torque", Site::link).empty());
}

/// Half of |thetad| is in one direction all that the base has of thetad: no other size is found.
TEST_CASE("what a half cannot tell does not disagree", "[refine]") {
  CHECK(disagreement("asymmetric_viscous.motor=1", "asymmetric_viscous", Site::motor).empty());
}

TEST_CASE("a wall is no gravity", "[refine]") {
  const std::string reason = disagreement("wall.link=1", "gravity_imbalance", Site::link);
  INFO(reason);
  CHECK(reason.find("its size differs between halves of the samples: ") == 0);
}

}  // namespace
