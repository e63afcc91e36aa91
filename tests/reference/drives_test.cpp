// Rigid drives measured by others: SRV-02 disc, XL330 servo on a pendulum, two screw drives. Their
// published numbers are nominal, so the bands are wide; what was found is printed.
#include "tests/reference/shared_data.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

DynamicPreload fit(const std::vector<LogSurvey>& logs, std::optional<double> rest = {}) {
  DynamicOptions options;
  options.models = {"rigid"};
  options.samples.rest_speed = rest;
  return fit_dynamic(logs, {}, options).preloads.at(0);
}

void print(const char* title, const DynamicPreload& preload) {
  std::printf("  %s (delay %.3g +- %.2g ms)\n", title, 1e3 * preload.delay.seconds,
              1e3 * preload.delay.sd);
  for (const Estimate& e : preload.fits.at(0).parameters)
    std::printf("    %-7s %12.5g +- %9.2g %-12s %s\n", e.name.c_str(), e.value, e.sd,
                e.unit.c_str(), e.not_identifiable.c_str());
  for (const Decision& d : preload.decisions)
    std::printf("    %s: %s (%s)\n", d.name.c_str(), d.value.c_str(), d.reason.c_str());
}

// Giulio Savian's students: Coulomb friction 0.0071 N m.
TEST_CASE("SRV-02 disc: Coulomb friction near the published one", "[reference]") {
  std::vector<LogSurvey> logs;
  for (const char* name : {"disc_accel_decel", "disc_speed_steps_pos", "disc_speed_steps_neg"}) {
    const std::string path = shared_file(std::string("srv02_padova/") + name + ".csv");
    if (path.empty()) return;
    logs.push_back(survey_file(path, default_rig()));
  }
  const DynamicPreload preload = fit(logs);
  print("SRV-02 disc", preload);
  CHECK_THAT(estimate(preload.fits.at(0).parameters, "f_s").value,
             Catch::WithinRel(0.0071, 0.3));
}

// Beam on the held hub: students' k 0.808 and Jb 1.4e-3, so K/J_link near 577; nominal 600.
TEST_CASE("SRV-02 beam: ratio of stiffness to inertia", "[reference]") {
  const std::string path = shared_file("srv02_padova/blocked_hub_freeosc_B.csv");
  if (path.empty()) return;
  std::string text = "t,q,theta\n";
  const std::string all = content_of(path);
  for (std::size_t at = all.find('\n') + 1; at < all.size(); at = all.find('\n', at) + 1) {
    const double t = std::stod(all.substr(at, all.find(',', at) - at));
    if (t >= 0.18 && t <= 2.74) text += all.substr(at, all.find('\n', at) + 1 - at);
  }
  Bench bench;
  bench.add_text(text);
  const DynamicPreload preload = fit_dynamic(bench.logs(), {}, {}).preloads.at(0);
  print("SRV-02 beam", preload);
  const Estimate& k = estimate(preload.fits.at(0).parameters, "K/J_link");
  CHECK(k.value > 450);
  CHECK(k.value < 700);
}

// Rhoban/bam: armature 0.00181 + arm 0.0049 kg m^2; tau_load is exact, Coulomb friction of a small
// geared servo some hundredths of a N m.
TEST_CASE("XL330: armature and arm", "[reference]") {
  std::vector<LogSurvey> logs;
  for (const char* name : {"kp100_sin_sin", "kp100_sin_time_square", "kp400_sin_sin",
                           "kp400_sin_time_square"}) {
    const std::string path = shared_file(std::string("bam_xl330/xl330_") + name + ".csv");
    if (path.empty()) return;
    logs.push_back(survey_file(path, default_rig()));
  }
  const DynamicPreload preload = fit(logs);
  print("XL330", preload);
  const std::vector<Estimate>& found = preload.fits.at(0).parameters;
  CHECK(estimate(found, "J").value > 0);
}

TEST_CASE("screw drives: friction from velocity logs", "[reference]") {
  for (const char* drive : {"drive2", "drive3"}) {
    std::vector<LogSurvey> logs;
    for (const char* speed : {"20", "50", "100", "160", "200", "n20", "n50", "n100", "n160", "n200"}) {
      const std::string path =
          shared_file(std::string("screw_drives/") + drive + "_steady_" + speed + "rpm.csv");
      if (path.empty()) return;
      logs.push_back(survey_file(path, default_rig()));
    }
    const DynamicPreload preload = fit(logs);
    print(drive, preload);
    const std::vector<Estimate>& found = preload.fits.at(0).parameters;
    CHECK(estimate(found, "f_s").value > 0);
    CHECK(estimate(found, "f_s").value < 0.02);
  }
}

}  // namespace
