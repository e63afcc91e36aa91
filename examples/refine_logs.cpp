// Which effect does the model lack? Trains on the first logs and judges on the last one.
// usage: refine_logs TRAINING_LOG... TEST_LOG
#include <cablefit/cablefit.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  try {
    cablefit::RefineLogs logs;
    logs.train = cablefit::read_logs({argv + 1, argv + argc});
    logs.test = {logs.train.back()};
    logs.train.pop_back();
    cablefit::RefineOptions options;
    options.n_draws = 8;
    options.threads = 2;
    const cablefit::RefineResult result = cablefit::missing_effects(logs, options);
    std::printf("%s: %s\n", std::string(cablefit::to_string(result.verdict)).c_str(),
                result.reason.c_str());
    for (const cablefit::NamedEffect& effect : result.effects)
      for (const cablefit::Estimate& e : effect.instance.parameters)
        std::printf("  %s %s = %.4g +- %.2g %s\n",
                    std::string(effect.instance.effect->name).c_str(), e.name.c_str(), e.value,
                    e.sd, e.unit.c_str());
    std::printf("gap on the test log: %.3g -> %.3g N m\n", result.torque.test_before,
                result.torque.test_after);
  } catch (const cablefit::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
