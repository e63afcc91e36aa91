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

// The repository's students give a Coulomb friction of 0.0071 N m, by a fit of their own. These
// logs show 0.0099: NumPy 1.24.2, speed over 0.2 s against torque averaged over the same, rows of
// disc_speed_steps_{pos,neg} with |w| > 1 rad/s and |dw/dt| < 0.5 rad/s^2,
//   numpy.linalg.lstsq([w, sign(w)], tau): 1.345e-4, 0.00994 (pos); 1.370e-4, 0.00979 (neg).
// The accelerations of the third log are part of the fit here, hence 5 and 10 %.
TEST_CASE("SRV-02 disc: friction as steady speeds show it", "[reference]") {
  std::vector<LogSurvey> logs;
  for (const char* name : {"disc_accel_decel", "disc_speed_steps_pos", "disc_speed_steps_neg"}) {
    const std::string path = shared_file(std::string("srv02_padova/") + name + ".csv");
    if (path.empty()) return;
    logs.push_back(survey_file(path, default_rig()));
  }
  const DynamicPreload preload = fit(logs);
  print("SRV-02 disc", preload);
  const std::vector<Estimate>& found = preload.fits.at(0).parameters;
  CHECK_THAT(estimate(found, "f_s").value, Catch::WithinRel(0.00987, 0.05));
  CHECK_THAT(estimate(found, "f_v").value, Catch::WithinRel(1.357e-4, 0.1));
  CHECK(std::abs(estimate(found, "f_s").value / 0.0071 - 1) < 0.4);
}

// Beam on the held hub: students' k 0.808 and Jb 1.4e-3, so K/J_link near 577; nominal 600. A
// damped sine through the same rows, a exp(-b t) cos(w t + c) + d by scipy.optimize.least_squares
// (SciPy 1.10.1): w^2 + b^2 = 575.1 1/s^2, 2 b = 1.43 1/s with all friction taken for viscous.
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
  CHECK_THAT(k.value, Catch::WithinRel(575.1, 0.05));
  CHECK(k.sd < 0.05 * k.value);
}

// Rhoban/bam: armature 0.00181 + arm 0.0049 kg m^2; tau_load is exact, Coulomb friction of a small
// geared servo some hundredths of a N m.
TEST_CASE("XL330: armature and arm", "[reference]") {
  std::vector<LogSurvey> logs;
  for (const char* name :
       {"kp100_sin_sin", "kp100_sin_time_square", "kp400_sin_sin", "kp400_sin_time_square"}) {
    const std::string path = shared_file(std::string("bam_xl330/xl330_") + name + ".csv");
    if (path.empty()) return;
    logs.push_back(survey_file(path, default_rig()));
  }
  const DynamicPreload preload = fit(logs);
  print("XL330", preload);
  const std::vector<Estimate>& found = preload.fits.at(0).parameters;
  // The servo's model of these authors has two inertias; friction is theirs to a factor only.
  CHECK_THAT(estimate(found, "J").value, Catch::WithinRel(0.00181 + 0.0049, 0.1));
  CHECK(estimate(found, "f_s").value > 0.005);
  CHECK(estimate(found, "f_s").value < 0.1);
}

// drive2_velocity_torque_map.csv, one row per speed, rounded means over both directions: 0.0049 N m
// at any speed from 1 to 21 rad/s.
TEST_CASE("screw drives: friction from velocity logs", "[reference]") {
  for (const std::string drive : {"drive2", "drive3"}) {
    std::vector<LogSurvey> logs;
    for (const char* speed :
         {"20", "50", "100", "160", "200", "n20", "n50", "n100", "n160", "n200"}) {
      const std::string path =
          shared_file("screw_drives/" + drive + "_steady_" + speed + "rpm.csv");
      if (path.empty()) return;
      logs.push_back(survey_file(path, default_rig()));
    }
    const DynamicPreload preload = fit(logs);
    print(drive.c_str(), preload);
    const std::vector<Estimate>& found = preload.fits.at(0).parameters;
    CHECK(estimate(found, "f_s").value > 0);
    CHECK(estimate(found, "f_s").value < 0.02);
    // Speeds that stay constant say nothing of an inertia, here 2.2e-6 and 6.5e-7 kg m^2.
    CHECK_FALSE(estimate(found, "J").not_identifiable.empty());
    if (drive == "drive2") CHECK_THAT(estimate(found, "f_s").value, Catch::WithinRel(0.0049, 0.1));
  }
}

}  // namespace
