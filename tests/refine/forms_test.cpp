// A law has a plain form, which coefficients are those of, and a fuller one, which names what is
// like it.
#include <catch2/catch.hpp>

#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/search/quick_look.hpp"
#include "cablefit/refine/search/scan.hpp"
#include "tests/refine/hidden_logs.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

BaseFit base_of(const HiddenLogs& hidden) {
  std::vector<LogSurvey> all = hidden.logs.blocked;
  all.insert(all.end(), hidden.logs.train.begin(), hidden.logs.train.end());
  return fit_base(
      make_design(hidden.models,
                  read_stretches(all, hidden.models, [](const PartSurvey&) { return true; }),
                  smoothing_for(1e-3)),
      2, nullptr);
}

/// The best candidate of one row, its shape refined.
Candidate best_of(const BaseFit& base, std::string_view name, Site site) {
  std::vector<const Effect*> others;
  for (const Effect& row : candidate_effects())
    if (row.name != name || row.site != site) others.push_back(&row);
  const ScanStart start{base.design, base.grams, base.fit, base.levels};
  const auto found = scan(start, {}, others);
  REQUIRE(found.size() == 1);
  return refined_shape(start, {}, found.front());
}

double truth(const HiddenLogs& hidden) {
  return hidden.truth.effects.at(0).coefficients.at(0).value;
}

}  // namespace

TEST_CASE("a sine has one harmonic", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"gravity_imbalance.link=0.3"}, 2);
  const Candidate best = best_of(base_of(hidden), "gravity_imbalance", Site::link);
  CHECK(best.variant.is_plain);
  const double amplitude = best.x.tail(2).norm();
  CHECK(amplitude == Approx(truth(hidden)).epsilon(0.05));  // 60 % off with a second harmonic
}

TEST_CASE("a second harmonic that is there is kept", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"cogging.motor.two_harmonics=1"});
  const Candidate best = best_of(base_of(hidden), "cogging", Site::motor);
  CHECK_FALSE(best.variant.is_plain);
  const Eigen::VectorXd own = best.x.tail(4);
  CHECK(own.head(2).norm() == Approx(truth(hidden)).epsilon(0.05));
  CHECK(own.tail(2).norm() == Approx(0.5 * truth(hidden)).epsilon(0.1));
}

/// A motor's poles behind a reduction: no grid has orders that dense.
TEST_CASE("a ripple of many periods is found above the grid", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"cogging.motor.geared=1"});
  const BaseFit base = base_of(hidden);
  const Candidate best = best_of(base, "cogging", Site::motor);
  const double order = hidden.truth.effects.at(0).coefficients.at(1).value;
  CHECK(order > best.variant.effect->shape.front().grid_end(base.design.scale));
  CHECK(best.variant.is_plain);
  CHECK(best.variant.shape.at(0) == Approx(order).epsilon(0.002));
  CHECK(best.x.tail(2).norm() == Approx(truth(hidden)).epsilon(0.1));
}

TEST_CASE("an exponent is that of the textbooks unless the blocks want another", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"quadratic_drag.motor=0.3"}, 2);
  const Candidate best = best_of(base_of(hidden), "quadratic_drag", Site::motor);
  CHECK(best.variant.is_plain);
  CHECK(best.variant.shape.at(0) == 2);
  CHECK(best.x.tail(1)(0) == Approx(truth(hidden)).epsilon(0.05));
}

/// More of it than there is dry friction is a simulation that drives itself.
TEST_CASE("presliding takes all of the dry friction, not more", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"presliding.link=0.1"});
  const BaseFit base = base_of(hidden);
  const Candidate best = best_of(base, "presliding", Site::link);
  CHECK(best.refused.empty());
  CHECK(best.variant.is_plain);
  CHECK(best.variant.shape.at(0) == Approx(truth(hidden)).epsilon(0.15));
  // The share left free comes out larger than one on these logs.
  const Design free =
      with_variant(base.design, {best.variant.effect, best.variant.shape, 0, 0, false}, base.fit.x);
  const auto fit = fit_blocks(block_grams(free.rows, free.stretches, 2), base.levels);
  REQUIRE(fit);
  CHECK(fit->x(fit->x.size() - 1) > fit->x(base.design.layout.dry_link));
}

/// What remembers its way stands at the middle of the step, as the motion does; at its end it is 3
/// % too far.
TEST_CASE("presliding has its distance", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"presliding.link=0.3"}, 2);
  const Candidate best = best_of(base_of(hidden), "presliding", Site::link);
  CHECK(best.variant.shape.at(0) == Approx(truth(hidden)).epsilon(0.015));
}

/// Beyond the peak there would be no torque left to explain.
TEST_CASE("the grid of what the drive loses ends far below the peak", "[refine]") {
  const Effect& row = find_candidate("drive_dead_band", Site::drive);
  for (const double peak : {0.05, 50.0}) CHECK(row.shape[0].highest({peak, 1}) < 0.1 * peak);
}

TEST_CASE("a quick look is the fit in sample", "[refine]") {
  const HiddenLogs hidden = hidden_logs({"gravity_imbalance.link=1"});
  const BaseFit base = base_of(hidden);
  const Variant gravity{&find_candidate("gravity_imbalance", Site::link), {}, 0, 0, false};
  const VariantColumns columns = variant_columns(base.design, gravity, base.fit.x);
  const QuickLook look(base.design, base.grams, base.levels);
  const auto products =
      look.products(active_columns(base.design, gravity, base.fit.x, Evaluation::fine));
  const auto glance = look.with(products, 4, 0);
  const auto fit = fit_blocks(
      extended(base.grams, base.design.rows, base.design.stretches, columns, 2), base.levels);
  REQUIRE(glance);
  REQUIRE(fit);
  CHECK(glance->error == Approx(fit->in_sample.sum()).epsilon(1e-6));
  CHECK((glance->x - fit->x.tail(4)).norm() < 1e-6 * glance->x.norm());
  CHECK_FALSE(look.with(products, 4, 1));  // none is all its own
}

/// A linear model of cables that stiffen: the next order of a pair, no limit of the drive.
TEST_CASE("a spring that stiffens is named on a linear base", "[refine]") {
  HiddenLogs hidden = hidden_logs({});
  for (Model& model : hidden.models) {
    model.transmission.cables.clear();
    model.transmission.linear_stiffness = Eigen::VectorXd::Constant(1, 1600);
  }
  const BaseFit base = base_of(hidden);
  const Candidate order = best_of(base, "stiffness_order", Site::transmission);
  CHECK(order.gain > 0.9);
  CHECK(order.gain > best_of(base, "saturation", Site::drive).gain);
  // What is made of cables needs some: a second variant may not stand alone.
  const Design pair = with_variant(base.design, order.variant, base.fit.x);
  const Effect& asymmetry = find_candidate("stiffness_asymmetry", Site::transmission);
  CHECK(applies(base.design, {&asymmetry, {}, 0, 0, false}));
  CHECK_FALSE(applies(pair, {&asymmetry, {}, 0, 0, false}));
}
