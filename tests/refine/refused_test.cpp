// What refinements cannot be asked for says so in words; no assertion is reached.
#include <catch2/catch.hpp>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/output_error/output_error.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "tests/refine/hidden_logs.hpp"

using namespace cablefit;
using namespace cablefit::test;

TEST_CASE("output error refuses a model whose sensors are wrong", "[refine][refused]") {
  Model model = hidden_logs({}).models.front();
  EffectInstance instance;
  instance.effect = &find_candidate("encoder_delay", Site::sensor);
  for (const ParameterInfo& info : instance.effect->parameters) {
    instance.parameters.emplace_back();
    instance.parameters.back().name = info.name;
    instance.parameters.back().value = 0.1;
  }
  model.joints.front().added.push_back(instance);
  try {
    fit_output_error(model, {}, {});
    FAIL("it was taken");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::usage);
    CHECK(std::string(error.what()) ==
          "output error cannot fit a model with 'encoder_delay' (sensor) in it; use "
          "`cablefit refine`, which fits this effect");
  }
}
