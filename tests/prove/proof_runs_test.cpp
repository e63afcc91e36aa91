// What the runs of a proof say together.
#include "cablefit/prove/proof_runs.hpp"

#include <catch2/catch.hpp>

using namespace cablefit;

TEST_CASE("where every run failed nothing is proved", "[prove]") {
  Estimate stiffness;
  stiffness.name = "K";
  stiffness.value = 2000;
  stiffness.sd = 10;
  ProveOptions options;
  options.n_runs = 3;
  const FitProof proof = prove_by_runs({stiffness}, options, {}, [](std::uint64_t) {
    return ProofRun{{}, "no stage 1"};
  });
  CHECK(proof.n_failed == 3);
  CHECK(proof.first_failure == "no stage 1");
  CHECK(proof.verdict == "not proved: no run ended with estimates");
}

TEST_CASE("a parameter that most runs do not determine is reported", "[prove]") {
  Estimate stiffness;
  stiffness.name = "K";
  stiffness.value = 2000;
  stiffness.sd = 10;
  stiffness.ci_low = 1980;
  stiffness.ci_high = 2020;
  ProveOptions options;
  options.n_runs = 4;
  options.seed = 0;
  const FitProof proof = prove_by_runs({stiffness}, options, {}, [&](std::uint64_t seed) {
    return seed == 0 ? ProofRun{{stiffness}, ""} : ProofRun{};
  });
  CHECK(proof.parameters.at(0).n_open == 3);
  CHECK(proof.parameters.at(0).verdict == "covers; not determined in 3 of 4 runs");
  CHECK(proof.verdict ==
        "the 95 % intervals contain the true values; most runs do not determine K");
}

TEST_CASE("what the fit does not determine is not tested, and the proof says so", "[prove]") {
  Estimate open;
  open.name = "K1_0";
  open.not_identifiable = "is not separable";
  Estimate stiffness;
  stiffness.name = "K";
  stiffness.value = stiffness.ci_low = stiffness.ci_high = 2000;
  stiffness.sd = 10;
  ProveOptions options;
  options.n_runs = 3;
  const auto proof_of = [&](const std::vector<Estimate>& truth) {
    return prove_by_runs(truth, options, {}, [&](std::uint64_t) { return ProofRun{truth, ""}; });
  };
  const FitProof some = proof_of({open, stiffness});
  CHECK(some.parameters.size() == 1);
  CHECK(some.notes == std::vector<std::string>{"not tested: K1_0 (not determined by the fit)"});
  CHECK(some.verdict == "the 95 % intervals contain the true values");
  CHECK(proof_of({open}).verdict == "not proved: the fit determines no parameter");
}
