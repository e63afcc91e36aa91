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
