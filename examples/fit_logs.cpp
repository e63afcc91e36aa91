// Fits logs: how stiff is the transmission, and what are the inertias and frictions?
// usage: fit_logs LOG...
#include <cablefit/cablefit.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  try {
    const std::vector<cablefit::LogSurvey> logs = cablefit::read_logs({argv + 1, argv + argc});
    const cablefit::ElasticResult stage1 = cablefit::stiffness(logs);
    const cablefit::DynamicResult stage2 = cablefit::dynamics(logs, stage1);
    for (const cablefit::DynamicPreload& preload : stage2.preloads)
      for (const cablefit::Estimate& e : preload.fits.front().parameters)
        std::printf("%-8s %10.4g +- %.2g %s\n", e.name.c_str(), e.value, e.sd, e.unit.c_str());
  } catch (const cablefit::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
