// cablefit simulate from the outside: command, exit code, text and files.
#include <catch2/catch.hpp>

#include "tests/cli/case_file.hpp"
#include "tests/support/low_model.hpp"

namespace {

using namespace cablefit::test;

Outcome run(const std::string& command, const std::string& model = kLowModel) {
  Case wanted;
  wanted.files = {{"model.json", model},
                  {"short.csv", "t,q\n0,0\n1,0\n2,0\n3,0\n4,0\n5,0\n6,0\n7,0\n"}};
  wanted.prepare = {"cp '" CABLEFIT_DATA "'/low/blocked.csv '" CABLEFIT_DATA
                    "'/low/moving_load30.csv '" CABLEFIT_DATA "'/low/rig.json ."};
  wanted.run = command;
  return run_case(wanted);
}

using Files = std::vector<std::string>;

TEST_CASE("simulate prints gaps and writes its result") {
  const Outcome outcome =
      run("cablefit simulate model.json moving_load30.csv blocked.csv --trajectories rows.csv "
          "--report gaps.csv --json all.json");
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err == "");
  CHECK_THAT(outcome.out, Catch::Matchers::Contains("Gap: simulated minus measured"));
  CHECK_THAT(outcome.out, Catch::Matchers::Contains("  model 'poly' of model.json"));
  CHECK(outcome.created == Files{"all.json", "cablefit-out/simulate.json", "gaps.csv", "rows.csv"});
}

TEST_CASE("simulate takes the result of stage 2 when no model is named") {
  const Outcome outcome =
      run("cablefit dynamic blocked.csv moving_load30.csv --quiet 2> warnings; "
          "cablefit simulate moving_load30.csv --model linear");
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Catch::Matchers::Contains("model 'linear', from "
                                                    "cablefit-out/dynamic.json"));
}

void check_refused(const std::string& command, int exit_code, const std::string& message) {
  const Outcome outcome = run(command);
  INFO(command);
  CHECK(outcome.exit_code == exit_code);
  CHECK(outcome.out == "");
  CHECK(outcome.err == message + "\n");
  CHECK(outcome.created == Files{});
}

TEST_CASE("what simulate refuses") {
  check_refused("cablefit simulate", 2,
                "no model and no log given; see 'cablefit simulate --help'");
  check_refused("cablefit simulate model.json", 2,
                "no log given; name one or more logs after MODEL");
  check_refused("cablefit simulate blocked.csv", 2,
                "no model given and no cablefit-out/dynamic.json; name a model file or a result of "
                "'cablefit dynamic' before the logs");
  check_refused("cablefit simulate model.json blocked.csv --mode open", 2,
                "unknown mode 'open'; known: auto, closed-loop, torque");
  check_refused("cablefit simulate model.json short.csv --trajectories rows.csv", 3,
                "short.csv:1: missing column 'theta', needed for the initial state of a "
                "simulation; add it, or map it in a rig file; columns are t, q");
  check_refused(
      "cablefit simulate model.json blocked.csv --mode closed-loop", 3,
      "blocked.csv: no reference 'theta_ref' in the log; a closed loop needs a controller in "
      "the rig file and its reference in the log; or replay the torque");
}

TEST_CASE("no file of a simulation takes the place of another") {
  for (const std::string other : {"blocked.csv", "model.json", "all.json"}) {
    check_refused(
        "cablefit simulate model.json blocked.csv --json all.json --trajectories ./" + other, 2,
        "the trajectories would overwrite " + other + "; choose another --trajectories");
  }
  check_refused("cablefit simulate model.json blocked.csv --json model.json", 2,
                "'model.json' would be overwritten by the result made from it; choose another "
                "--out, --json or --report");
  check_refused("cablefit simulate model.json blocked.csv --trajectories -", 2,
                "--trajectories cannot be '-'; give the name of a file");
}

TEST_CASE("a result of stage 1 alone is not a model") {
  const Outcome outcome =
      run("cablefit elastic blocked.csv --quiet --order 2 && "
          "cablefit simulate cablefit-out/elastic.json moving_load30.csv");
  CHECK(outcome.exit_code == 3);
  CHECK(outcome.err ==
        "cablefit-out/elastic.json:2:13: schema 'cablefit/elastic/1' is not a model; "
        "expected 'cablefit/model/1', or 'cablefit/dynamic/1' as `cablefit dynamic` "
        "writes it\n");
}

TEST_CASE("exit code 4 when a simulation diverges, its result is written all the same") {
  std::string model = kLowModel;
  model.replace(model.find("1367.7, 37844.1"), 15, "-1e5, 0");
  const Outcome outcome = run("cablefit simulate model.json moving_load30.csv --quiet", model);
  CHECK(outcome.exit_code == 4);
  CHECK_THAT(outcome.err,
             Catch::Matchers::Contains("moving_load30.csv: the simulation diverged at t = "));
  CHECK(outcome.created == Files{"cablefit-out/simulate.json"});
}

TEST_CASE("trajectories that cannot be written") {
  const Outcome outcome =
      run("cablefit simulate model.json blocked.csv --trajectories model.json/rows.csv");
  CHECK(outcome.exit_code == 5);
  CHECK(outcome.err == "cannot write model.json/rows.csv: Not a directory\n");
  CHECK(outcome.created == Files{});
}

}  // namespace
