// The decision rule on made-up candidates.
#include "cablefit/refine/verdict/verdict.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/random.hpp"

using namespace cablefit;

namespace {

constexpr Eigen::Index kBlocks = 20;

/// A candidate that removes `share` of the squared error 1000 (of which noise is 500), the same in
/// every block but for `unevenness`.
Candidate candidate(std::string_view name, Site site, double share, double unevenness = 0) {
  Candidate c;
  c.variant.effect = &find_candidate(name, site);
  c.x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(c.variant.effect->n_linear()));
  c.gain = share;
  c.error = Eigen::ArrayXd::Constant(kBlocks, 1000 * (1 - share) / kBlocks);
  for (Eigen::Index b = 0; b < kBlocks; ++b) c.error(b) += (b % 2 == 0 ? 1 : -1) * unevenness;
  return c;
}

constexpr SquaredGap kGap{1000, 500};

/// Searches of nothing, whose best gains are about 0.3 %.
std::vector<NullDraw> draws(double event_gain = 0.002) {
  std::vector<NullDraw> all;
  for (int k = 0; k < 20; ++k) {
    NullDraw draw;
    draw.gains[&find_candidate("stribeck", Site::motor)] = 0.002 + 1e-4 * k;
    draw.gains[&find_candidate("contact", Site::link)] = event_gain;
    all.push_back(draw);
  }
  return all;
}

std::string best_name(const Judgement& j) {
  return j.best == nullptr ? "" : std::string(j.best->variant.effect->name);
}

bool lists(const std::vector<Rival>& rivals, std::string_view name) {
  return std::any_of(rivals.begin(), rivals.end(), [&](const Rival& r) { return r.name == name; });
}

}  // namespace

TEST_CASE("the largest gain beyond chance is named", "[refine]") {
  const std::vector<Candidate> candidates = {candidate("stribeck", Site::motor, 0.4),
                                             candidate("quadratic_drag", Site::motor, 0.2)};
  const Judgement j = judge_search(candidates, kGap, draws(), {}, true);
  CHECK(j.is_named);
  CHECK(best_name(j) == "stribeck");
  CHECK(j.rivals.empty());
  CHECK(j.ranking.at(0).gain == Approx(0.8));  // of the gap, not of the total
}

TEST_CASE("what chance finds, and what is immaterial, is not named", "[refine]") {
  RefineOptions options;
  options.materiality = 0.001;
  const std::vector<Candidate> chance = {candidate("stribeck", Site::motor, 0.004)};
  CHECK_FALSE(judge_search(chance, kGap, draws(), options, true).is_named);
  const std::vector<Candidate> clear = {candidate("stribeck", Site::motor, 0.008)};
  CHECK(judge_search(clear, kGap, draws(), options, true).is_named);
  CHECK_FALSE(judge_search(clear, kGap, draws(), {}, true).is_named);  // 1 % by default
  CHECK_FALSE(judge_search(clear, kGap, {}, options, true).is_named);  // without a null
}

/// Under the null, a low-frequency disturbance on the link gives gains to the rows of the link, not
/// to those of the motor.
TEST_CASE("a gain is counted in what its own row gains by chance", "[refine]") {
  std::vector<NullDraw> wandering;
  for (int k = 0; k < 20; ++k) {
    NullDraw draw;
    const double luck = 1 + 0.05 * (k % 7);
    draw.gains[&find_candidate("stribeck", Site::link)] = 0.04 * luck;
    for (const char* name : {"stribeck", "quadratic_drag", "nonlinear_viscous"})
      draw.gains[&find_candidate(name, Site::motor)] = 0.002 * luck;
    wandering.push_back(draw);
  }
  const auto is_named = [&](Site site) {
    return judge_search({candidate("stribeck", site, 0.05)}, kGap, wandering, {}, true).is_named;
  };
  CHECK(is_named(Site::motor));
  CHECK_FALSE(is_named(Site::link));
}

/// One lucky draw of a row that gains nothing else is luck and no unit.
TEST_CASE("a row that gained once is not beyond all measure", "[refine]") {
  std::vector<NullDraw> once = draws();
  once.front().gains[&find_candidate("saturation", Site::drive)] = 0.004;
  CHECK(judge_search({candidate("stribeck", Site::motor, 0.1)}, kGap, once, {}, true).is_named);
}

/// 1 of 138 data sets without an effect had such a name, 1 % above its floor.
TEST_CASE("where there is no gap chance has to be ten times less likely", "[refine]") {
  std::vector<NullDraw> luck;
  for (int k = 0; k < 12; ++k)
    luck.emplace_back().gains[&find_candidate("stribeck", Site::motor)] = 0.002 + 0.001 * k;
  const auto at_rho = [&](double rho, double share) {
    const std::vector<Candidate> found = {candidate("stribeck", Site::motor, share)};
    return judge_search(found, {1000, 1000 / rho}, luck, {}, true);
  };
  const double p = at_rho(1.2, 0.03).chance.p;
  CHECK(p > 0.001);
  CHECK(p < 0.01);
  CHECK(at_rho(1.2, 0.03).is_named);
  CHECK_FALSE(at_rho(1.01, 0.03).is_named);
  CHECK(at_rho(1.01, 0.05).is_named);
}

/// The trap: scores of events are in sample, and large where nothing happened.
TEST_CASE("an event has to beat its own null", "[refine]") {
  const std::vector<Candidate> candidates = {candidate("contact", Site::link, 0.09)};
  CHECK(judge_search(candidates, kGap, draws(0.002), {}, true).is_named);
  CHECK_FALSE(judge_search(candidates, kGap, draws(0.08), {}, true).is_named);
}

/// The trap: for a low-frequency disturbance or a tone, times all over the logs are as good as the
/// best one.
TEST_CASE("what passes has to stand out of other dates", "[refine]") {
  std::vector<Candidate> candidates = {candidate("contact", Site::link, 0.09)};
  candidates[0].elsewhere = 0.02;
  CHECK(judge_search(candidates, kGap, draws(0.002), {}, true).is_named);
  candidates[0].elsewhere = 0.03;
  CHECK_FALSE(judge_search(candidates, kGap, draws(0.002), {}, true).is_named);
}

/// The trap: a log begins unlike the simulated ones.
TEST_CASE("without a gap nothing happened", "[refine]") {
  const std::vector<Candidate> candidates = {candidate("contact", Site::link, 0.02)};
  CHECK(judge_search(candidates, {1000, 900}, draws(0.002), {}, true).is_named);
  CHECK_FALSE(judge_search(candidates, {1000, 960}, draws(0.002), {}, true).is_named);
  const std::vector<Candidate> lasting = {candidate("stribeck", Site::motor, 0.02)};
  CHECK(judge_search(lasting, {1000, 960}, draws(0.002), {}, true).is_named);
}

/// The trap: a date in sample gains what no law could.
TEST_CASE("what chance gives a search of dates is taken off first", "[refine]") {
  const std::vector<Candidate> candidates = {candidate("contact", Site::link, 0.42),
                                             candidate("gravity_imbalance", Site::link, 0.4)};
  CHECK(best_name(judge_search(candidates, kGap, draws(0.002), {}, true)) == "contact");
  CHECK(best_name(judge_search(candidates, kGap, draws(0.1), {}, true)) == "gravity_imbalance");
}

TEST_CASE("a physical bound is not negotiable", "[refine]") {
  std::vector<Candidate> candidates = {candidate("stribeck", Site::motor, 0.4),
                                       candidate("quadratic_drag", Site::motor, 0.2)};
  candidates[0].refused = "beyond its physical bound";
  const Judgement j = judge_search(candidates, kGap, draws(), {}, true);
  CHECK(best_name(j) == "quadratic_drag");
  CHECK_FALSE(lists(j.rivals, "stribeck"));
  CHECK(j.ranking.back().refused == "beyond its physical bound");
}

TEST_CASE("look-alikes are listed, and the simplest of equals is the headline", "[refine]") {
  // Four parameters that are a trifle better than one.
  const std::vector<Candidate> ties = {candidate("pulley_eccentricity", Site::transmission, 0.402),
                                       candidate("encoder_scale", Site::sensor, 0.4)};
  const Judgement j = judge_search(ties, kGap, draws(), {}, true);
  CHECK(best_name(j) == "encoder_scale");
  CHECK(lists(j.rivals, "pulley_eccentricity"));
  // Twenty points of the gap apart, but the blocks do not agree on it.
  const std::vector<Candidate> unsure = {candidate("stribeck", Site::motor, 0.4, 20),
                                         candidate("presliding", Site::motor, 0.35, -20)};
  CHECK(lists(judge_search(unsure, kGap, draws(), {}, true).rivals, "presliding"));
  const std::vector<Candidate> sure = {candidate("stribeck", Site::motor, 0.4),
                                       candidate("presliding", Site::motor, 0.35)};
  CHECK_FALSE(lists(judge_search(sure, kGap, draws(), {}, true).rivals, "presliding"));
}

/// At one load a torque scale closes 3 % more of the gap than the wrong zero that made it.
TEST_CASE("what closes nearly as much is listed even where all blocks prefer another", "[refine]") {
  const auto is_listed = [](double apart) {  // share of the gap
    const double less = apart * (kGap.total - kGap.floor) / kGap.total;
    const std::vector<Candidate> found = {candidate("torque_gain", Site::drive, 0.4),
                                          candidate("encoder_offset", Site::sensor, 0.4 - less)};
    const Judgement j = judge_search(found, kGap, draws(), {}, true);
    CHECK(best_name(j) == "torque_gain");
    return lists(j.rivals, "encoder_offset");
  };
  CHECK(is_listed(0.028));
  CHECK_FALSE(is_listed(0.035));
}

TEST_CASE("what acts on the robot comes before what a sensor reads", "[refine]") {
  const auto first = [](double sensor, double torque) {
    return best_name(judge_search({candidate("encoder_offset", Site::sensor, sensor),
                                   candidate("constant_torque", Site::link, torque)},
                                  kGap, draws(), {}, true));
  };
  CHECK(first(0.402, 0.4) == "constant_torque");
  CHECK(first(0.44, 0.4) == "encoder_offset");  // no tie
}

/// 1.2 % of the gap in every block is more than luck: the simpler one is a rival, not the headline.
TEST_CASE("the simplest is not the headline where all blocks know better", "[refine]") {
  const std::vector<Candidate> sure = {candidate("gravity_imbalance", Site::link, 0.406, 0.05),
                                       candidate("constant_torque", Site::link, 0.4)};
  const Judgement j = judge_search(sure, kGap, draws(), {}, true);
  CHECK(best_name(j) == "gravity_imbalance");
  CHECK(lists(j.rivals, "constant_torque"));
  const std::vector<Candidate> unsure = {candidate("gravity_imbalance", Site::link, 0.406, 2),
                                         candidate("constant_torque", Site::link, 0.4)};
  CHECK(best_name(judge_search(unsure, kGap, draws(), {}, true)) == "constant_torque");
}

TEST_CASE("aliases are always listed together", "[refine]") {
  const auto rivals_of = [](const Candidate& c) {
    return judge_search({c}, kGap, draws(), {}, true).rivals;
  };
  CHECK(lists(rivals_of(candidate("constant_torque", Site::link, 0.4)), "asymmetric_coulomb"));
  CHECK(lists(rivals_of(candidate("torque_gain", Site::drive, 0.4)), "load_scale"));
  CHECK(lists(rivals_of(candidate("dead_zone", Site::transmission, 0.4)), "preload"));
}

TEST_CASE("a further effect has to carry more", "[refine]") {
  RefineOptions options;
  const std::vector<Candidate> crumb = {candidate("stribeck", Site::motor, 0.015)};
  CHECK(judge_search(crumb, kGap, draws(), options, true).is_named);
  CHECK_FALSE(judge_search(crumb, kGap, draws(), options, false).is_named);
}

/// 1 - exp(-(1 + (g - mode) / (k scale))^-k), k = n - 1, worked out by hand.
TEST_CASE("the tail of the largest gain", "[refine]") {
  const std::vector<double> largest = {0.001, 0.002, 0.003};
  // mean .002, sd .001: scale 7.79697e-4, mode 1.549946e-3.
  CHECK(tail_of_largest(largest, 0.006).p == Approx(0.0651183).epsilon(1e-5));
  CHECK(tail_of_largest(largest, 0.006).is_fitted);
  CHECK(tail_of_largest(largest, 0.0025).p == Approx(0.5));  // one of three is above
  CHECK_FALSE(tail_of_largest(largest, 0.0025).is_fitted);
  CHECK(tail_of_largest({}, 1).p == 1);
}

/// Four draws say nothing of one in ten thousand, however far the gain is beyond them.
TEST_CASE("a fitted tail goes no further than its draws support", "[refine]") {
  const std::vector<double> four = {0.001, 0.002, 0.003, 0.002};
  CHECK(tail_of_largest(four, 1).p == Approx(0.002));  // two decades beyond 1 in 5
  CHECK(tail_of_largest(std::vector<double>(24, 0.001), 1).p == Approx(4e-4));
  CHECK(least_tail(100000) == Approx(1e-4));
  CHECK(judge_search({candidate("stribeck", Site::motor, 0.4)}, kGap, draws(), {}, true)
            .chance.is_fitted);
}

/// The trap: a Gumbel distribution with mode and scale of six draws as if these were known says
/// 0.01 four times as often as it should.
TEST_CASE("p of few draws is that of the next one", "[refine]") {
  Random random(1, 5);
  const auto gumbel = [&] { return -std::log(-std::log(random.uniform())); };
  for (const std::size_t n : {6, 12, 24}) {
    constexpr int kRuns = 20000;
    int hundredth = 0, twentieth = 0;
    for (int run = 0; run < kRuns; ++run) {
      std::vector<double> largest(n);
      for (double& one : largest) one = gumbel();
      const double p = tail_of_largest(largest, gumbel()).p;
      hundredth += p <= 0.01 ? 1 : 0;
      twentieth += p <= 0.05 ? 1 : 0;
    }
    INFO(n << " draws");
    CHECK(hundredth == Approx(0.01 * kRuns).epsilon(0.25));
    CHECK(twentieth < 0.06 * kRuns);  // counted p are whole parts of n + 1
  }
}

TEST_CASE("p of draws that were asked for one by one", "[refine]") {
  std::vector<double> twelve = {1, 1, 1, 1, 1, 1, 5, 1, 5, 1, 1, 1};
  // None of the first six and two of the others: (1 + 6/12 + 6/12 5/11) / 13.
  CHECK(tail_of_sequence(twelve, 4).p == Approx((1 + 0.5 + 2.5 / 11) / 13));
  twelve[0] = twelve[3] = 6;
  CHECK(tail_of_sequence(twelve, 4).p == Approx(3.0 / 7));
  twelve.resize(6);
  CHECK(tail_of_sequence(twelve, 4).p == Approx(3.0 / 7));
  CHECK(tail_of_sequence(twelve, 10).is_fitted);
}

/// The trap: (1 + count) / (1 + n) of draws that go on only where the first six say little takes
/// small p back, so that they are too few.
TEST_CASE("p of a search that draws more where it has to is uniform", "[refine]") {
  constexpr int kRuns = 40000;
  Random random(1, 6);
  // Largest gains of a search scatter as a Gumbel distribution, which the fitted tail supposes.
  const auto gumbel = [&] { return -std::log(-std::log(random.uniform())); };
  const std::vector<double> at = {0.01, 0.04, 1.75 / 25, 1.0 / 7, 3.0 / 7, 5.0 / 7};
  std::vector<int> below(at.size(), 0);
  for (int run = 0; run < kRuns; ++run) {
    const double gain = gumbel();
    std::vector<double> largest;
    while (largest.size() < 6) largest.push_back(gumbel());
    const bool goes_on = *std::max_element(largest.begin(), largest.end()) < gain;
    while (goes_on && largest.size() < 24) largest.push_back(gumbel());
    const double p = tail_of_sequence(largest, gain).p;
    for (std::size_t k = 0; k < at.size(); ++k) below[k] += p <= at[k] + 1e-9 ? 1 : 0;
  }
  for (std::size_t k = 0; k < at.size(); ++k) {
    INFO("p <= " << at[k]);
    // Counted p are exact; a fitted one is to within 25 % at 0.01, as above.
    const double sd = std::sqrt(at[k] * (1 - at[k]) / kRuns);
    CHECK(std::abs(below[k] / static_cast<double>(kRuns) - at[k]) <
          4 * sd + (k == 0 ? 0.25 * at[k] : 0));
  }
}

TEST_CASE("draws end where the answer is clear", "[refine]") {
  std::vector<NullDraw> six;
  for (int k = 0; k < 6; ++k)
    six.emplace_back().gains[&find_candidate("stribeck", Site::motor)] = 0.01 + 0.002 * k;
  const auto is_settled = [&](double share) {
    return judge_search({candidate("stribeck", Site::motor, share)}, kGap, six, {}, true)
        .is_settled;
  };
  CHECK(is_settled(0.012));       // like any draw
  CHECK_FALSE(is_settled(0.04));  // p about 0.01
  CHECK(is_settled(0.4));
}

/// The trap: a sure name that gains little ends the draws before a larger gain is known to be none.
TEST_CASE("draws go on while a larger gain is open", "[refine]") {
  std::vector<NullDraw> six;
  for (int k = 0; k < 6; ++k) {
    NullDraw& draw = six.emplace_back();
    draw.gains[&find_candidate("stribeck", Site::motor)] = 0.001 + 0.0002 * k;
    draw.gains[&find_candidate("slip", Site::transmission)] = 0.1 + 0.03 * k;
  }
  const std::vector<Candidate> found = {candidate("slip", Site::transmission, 0.5),
                                        candidate("stribeck", Site::motor, 0.05)};
  CHECK_FALSE(judge_search(found, kGap, six, {}, true).is_settled);
}
