// Fits the stiffness of one blocked log with the installed library. Exit code 0 when it did.
#include <cablefit/base/units.hpp>
#include <cablefit/elastic/elastic_fit.hpp>
#include <cablefit/model/rig.hpp>
#include <cablefit/version.hpp>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const cablefit::Rig rig = cablefit::rig_for_log(argv[1], "");
  const std::vector<cablefit::LogSurvey> logs = {
      cablefit::survey_log(cablefit::plan_log(argv[1], rig), rig.preload)};
  const cablefit::ElasticResult result = cablefit::fit_elastic(logs, {});
  const cablefit::Estimate& stiffness = result.preloads.front().fits.front().parameters.front();
  std::printf("cablefit %s: %s = %.1f N m/deg\n", cablefit::kVersion, stiffness.name.c_str(),
              stiffness.value * cablefit::parse_unit("deg").scale);
  return stiffness.name == "K" ? 0 : 1;
}
