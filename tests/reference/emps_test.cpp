// EMPS benchmark (Janot, Gautier, Brunot 2019, nonlinearbenchmark.org): the estimates published in
// EMPS_Description.pdf, with the settings published there: Butterworth order 4 at 100 Hz, zero
// phase, central differences, 49 samples dropped at the ends, decimation by 10, least squares.
#include "tests/reference/shared_data.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

struct Published {
  const char* name;
  const char* unit;
  double value, sd_white;
  double tolerance;  // relative, on the value
};

// The authors decimate with MATLAB's decimate (another FIR) and difference with another stencil:
// that moves a coefficient by a share of its own sd (M .11 %, Fv .56 %, Fc .50 %, offset 1.4 %),
// and the tolerances are at most that sd.
constexpr Published kPublished[] = {{"J", "kg", 95.1089, 0.1085, 0.001},
                                    {"f_v", "N s/m", 203.5034, 1.1460, 0.003},
                                    {"f_s", "N", 20.3935, 0.1012, 0.003},
                                    {"offset", "N", -3.1648, 0.0444, 0.01}};

TEST_CASE("EMPS: the published estimates with the published settings", "[reference]") {
  const std::string path = shared_file("emps/emps_ident.csv");
  if (path.empty()) return;
  Rig rig = default_rig();
  rig.linear_motion = true;
  const std::vector<LogSurvey> logs = {survey_file(path, rig)};
  const DynamicResult result = fit_dynamic(logs, {}, emps_options());
  const DynamicFit& fit = result.preloads.at(0).fits.at(0);
  for (const Published& p : kPublished) {
    const Estimate& e = estimate(fit.parameters, p.name);
    std::printf("  EMPS %-7s published %9.4f +- %7.4f  found %9.4f +- %7.4f (white), %7.4f\n",
                p.name, p.value, p.sd_white, e.value, e.sd_white, e.sd);
    CHECK(e.unit == p.unit);
    CHECK_THAT(e.value, Catch::WithinRel(p.value, p.tolerance));
    CHECK_THAT(e.sd_white, Catch::WithinRel(p.sd_white, 0.05));
  }
  std::printf("  EMPS relative error %.4f %% (4.0834), cond(W) %.4f (25.9883)\n",
              100 * fit.torque_error.at("rigid").relative, fit.condition.at("rigid"));
  CHECK_THAT(100 * fit.torque_error.at("rigid").relative, Catch::WithinAbs(4.08, 0.06));
  CHECK_THAT(fit.condition.at("rigid"), Catch::WithinRel(25.9883, 0.05));
}

}  // namespace
