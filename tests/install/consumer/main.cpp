// Fits the stiffness of one blocked log with the installed library. Exit code 0 when it did.
#include <cablefit/cablefit.hpp>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const cablefit::ElasticResult result = cablefit::stiffness(cablefit::read_logs({argv[1]}));
  const cablefit::Estimate& stiffness = result.preloads.front().fits.front().parameters.front();
  std::printf("cablefit %s: %s = %.1f %s\n", cablefit::kVersion, stiffness.name.c_str(),
              stiffness.value, stiffness.unit.c_str());
  return stiffness.name == "K" ? 0 : 1;
}
