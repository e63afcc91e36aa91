// The decision rule on unseen logs, on made-up gaps.
#include "cablefit/refine/conclusion.hpp"

#include <catch2/catch.hpp>

using namespace cablefit;

/// The trap: a term that improves the equation error and worsens the simulation.
TEST_CASE("the simulation of unseen logs has the last word", "[refine]") {
  const Refinement& row = find_refinement("presliding", Site::link);
  const SimulatedGap floor{1e-5, 0.1, ""}, before{2e-5, 0.2, ""}, worse{3e-5, 0.2, ""},
      better{1.5e-5, 0.2, ""}, failed{0, 0, "diverged"};
  CHECK(why_not_added({row, 1.5, 1.2, before, better, floor}).empty());
  CHECK(
      why_not_added({row, 1.5, 1.2, before, worse, floor}) ==
      "unseen logs are not simulated better with it (4 times the squared floor before, 6.5 after)");
  CHECK(why_not_added({row, 1.5, 1.6, before, better, floor}) ==
        "the equations of unseen logs do not fit better with it (1.5 times the squared floor "
        "before, 1.6 "
        "after)");
  CHECK(why_not_added({row, 1.5, 1.2, before, failed, floor}) ==
        "with it the simulation fails: diverged");
  // These logs do not show the effect: what they show already is their floor.
  CHECK(why_not_added({row, 1.01, 1.015, floor, floor, floor}).empty());
  CHECK_FALSE(why_not_added({row, 1.01, 1.1, floor, floor, floor}).empty());
  CHECK_FALSE(why_not_added({row, 1.01, 1.0, floor, before, floor}).empty());
  const Refinement& event = find_refinement("contact", Site::link);
  CHECK(why_not_added({event, 1.5, 1.6, before, worse, floor}).empty());  // is over in other logs
}

/// The trap: in a wandering torque the best of a search gains a little on other logs by chance.
TEST_CASE("beside a remainder a gain on unseen logs has to be clear", "[refine]") {
  const Refinement& row = find_refinement("friction_drift", Site::link);
  const SimulatedGap floor{1e-5, 0.1, ""}, before{2e-5, 0.2, ""}, better{1.5e-5, 0.2, ""};
  CHECK(why_not_added({row, 7, 6.9, before, better, floor, true, 3}).empty());
  CHECK(why_not_added({row, 7, 6.9, before, better, floor, false, 0.8}).empty());
  CHECK(why_not_added({row, 7, 3, before, better, floor, true, 0.8}).empty());
  CHECK(why_not_added({row, 7, 6.9, before, better, floor, true, 0.8, false, 1, 1e-4}) ==
        "beside what stays unexplained the equations of unseen logs are not clearly better with it "
        "(0.8 sd)");
  // The sum over all rows is that of the equation that wanders; rows weighted by what they leave.
  CHECK(why_not_added({row, 7, 7.01, before, better, floor, true, 1.2}).empty());
  CHECK_FALSE(why_not_added({row, 7, 7.01, before, better, floor, true, -1.2}).empty());
  CHECK_FALSE(why_not_added({row, 7, 7.01, before, better, floor, false, 1.2}).empty());
  CHECK_FALSE(why_not_added({row, 7, 9, before, better, floor, true, 1.2}).empty());
}

/// The trap: a wandering torque has a slope, a mean, a period; of forty rows one fits by chance.
TEST_CASE("beside a remainder a size has to be beyond chance", "[refine]") {
  const Refinement& row = find_refinement("gravity_imbalance", Site::link);
  const SimulatedGap floor{1e-5, 0.1, ""}, before{2e-5, 0.2, ""}, better{1.5e-5, 0.2, ""};
  const auto why = [&](bool beside_remainder, double sd_better, double chance) {
    return why_not_added(
        {row, 39, 38, before, better, floor, beside_remainder, sd_better, false, 1, chance});
  };
  CHECK(why(true, 3, 1e-5).empty());
  CHECK(why(false, 3, 4e-4).empty());
  CHECK(why(true, 3, 4e-4) ==
        "beside what stays unexplained a size like its own is not beyond chance (p = 0.0004 of one "
        "effect)");
  // What the training rows leave no doubt of has to be better on unseen rows, clearly or not.
  CHECK(why(true, 0.3, 1e-7).empty());
  CHECK_FALSE(why(true, 0.3, 1e-5).empty());
  CHECK_FALSE(
      why_not_added({row, 39, 41, before, better, floor, true, -1, false, 1, 1e-7}).empty());
}

/// The trap: a pair of the catalogue mimics a third mass, 98.7 % of the gap closed.
TEST_CASE("two at once have to leave nothing", "[refine]") {
  const Refinement& row = find_refinement("stribeck", Site::link);
  const SimulatedGap floor{1e-5, 0.1, ""}, before{1e-4, 1, ""}, most{2e-5, 0.2, ""},
      all{1.1e-5, 0.11, ""};
  CHECK(why_not_both({row, 56, 1.1, before, all, floor}).empty());
  CHECK_FALSE(why_not_both({row, 56, 1.7, before, all, floor}).empty());
  CHECK_FALSE(why_not_both({row, 56, 1.1, before, most, floor}).empty());
  CHECK_FALSE(why_not_both({row, 1.5, 1.6, before, all, floor}).empty());
  const Refinement& event = find_refinement("contact", Site::link);
  CHECK_FALSE(why_not_both({event, 56, 1.1, before, all, floor}).empty());
}

TEST_CASE("of two simulations the smaller gap counts, and one that is known", "[refine]") {
  const SimulatedGap floor{1e-5, 0.1, ""}, large{1e-4, 0.1, ""}, small{2e-5, 0.1, ""},
      failed{0, 0, "it diverged"};
  CHECK(&smaller(large, small, floor) == &small);
  CHECK(&smaller(small, large, floor) == &small);
  CHECK(&smaller(large, failed, floor) == &large);
  CHECK(&smaller(failed, large, floor) == &large);
}

/// The traps: a date explains a little of any hum, and nothing of logs that it should show in.
TEST_CASE("an event closes its part of the gap, and that of logs after it", "[refine]") {
  const Refinement& row = find_refinement("payload_change", Site::link);
  const SimulatedGap none{0, 0, "not simulated"};
  const auto reason = [&](double after, bool leaves_remainder, bool is_after, double closed) {
    return why_not_added({row, 5, after, none, none, none, leaves_remainder, 3, is_after, closed});
  };
  CHECK(reason(5.1, false, false, 0.9).empty());  // unseen logs have no say
  CHECK(reason(5.1, false, true, 0.9) ==
        "the equations of unseen logs do not fit better with it (5 times the squared floor before, "
        "5.1 after)");
  CHECK(reason(4, true, true, 0.3).empty());
  CHECK(reason(4.9, true, true, 0.03) ==
        "a date explains 3 % of the gap only, and the rest stays unexplained");
  CHECK(reason(3.9, true, true, 0.03).empty());  // logs after it show more of it
  CHECK(reason(4.2, true, true, 0.03) ==
        "a date explains 20 % of the gap only, and the rest stays unexplained");
  CHECK(reason(3.9, true, false, 0.03) ==
        "a date explains 3 % of the gap only, and the rest stays unexplained");
  CHECK(reason(4.9, false, true, 0.03).empty());
}

TEST_CASE("a simulation that shows no gap may scatter a little", "[refine]") {
  const Refinement& row = find_refinement("load_scale", Site::link);
  const SimulatedGap floor{1e-5, 0.1, ""}, before{1.05e-5, 0.105, ""}, little{1.07e-5, 0.107, ""},
      more{1.15e-5, 0.115, ""};
  CHECK(why_not_added({row, 1.2, 1.05, before, little, floor}).empty());
  CHECK_FALSE(why_not_added({row, 1.2, 1.05, before, more, floor}).empty());
}

TEST_CASE("at the floor there is nothing to explain, whatever was refused", "[refine]") {
  RefineResult result;
  result.steps.emplace_back().added = "stiffness_order";
  result.rho_before = 0.97;
  conclude(result);
  CHECK(result.verdict == Verdict::none);
  CHECK(result.reason.find("stiffness_order, was refused") != std::string::npos);
  result.rho_before = 1.15;
  conclude(result);
  CHECK(result.verdict == Verdict::unexplained);
}
