// Both stages on the shipped logs, then the fitted model against the same logs.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "tests/simulate/true_models.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr const char* kMovingLogs[] = {"moving_load30.csv", "moving_load-40.csv"};

/// The result of both stages on the logs of one preload, as a file.
class Fitted {
 public:
  explicit Fitted(const std::string& preload, const std::string& rig = "") : preload_(preload) {
    const std::string rig_option = rig.empty() ? "" : folder_.write("bench.json", rig);
    const auto survey = [&](const std::string& name) {
      const std::string path = std::string(CABLEFIT_DATA) + "/" + preload + "/" + name;
      const Rig log_rig = rig_for_log(path, rig_option);
      return survey_log(plan_log(path, log_rig), log_rig.preload);
    };
    ElasticOptions elastic;
    elastic.order = 2;
    const std::vector<LogSurvey> blocked = {survey("blocked.csv")};
    DynamicOptions dynamic;
    dynamic.models = {"linear", "poly"};
    const std::vector<LogSurvey> moving = {survey(kMovingLogs[0]), survey(kMovingLogs[1])};
    DynamicResult result = fit_dynamic(moving, fit_elastic(blocked, elastic), dynamic);
    // Beside one straight line for all cables the logs do not determine J_motor; what is simulated
    // is the spring, so that it gets the motor of the cables.
    std::vector<DynamicFit>& fits = result.preloads.at(0).fits;
    for (Estimate& e : fits.at(0).parameters)
      if (!e.not_identifiable.empty()) e = *find_estimate(fits.at(1).parameters, e.name);
    folder_.write("dynamic.json", dynamic_json(result));
  }
  Model model(const std::string& name) const {
    std::string choice;
    return read_model(folder_.file("dynamic.json"), preload_, name, choice);
  }

 private:
  TempFolder folder_;
  std::string preload_;
};

constexpr double kTimes = 2;           // of what the true model leaves
constexpr double kProportional = 800;  // kp of the controller, N m/rad

double offset_sd(const Model& model) {
  for (const EffectInstance& instance : model.joints.at(0).motor) {
    if (instance.effect->name == "offset") return instance.parameters.at(0).sd;
  }
  throw std::runtime_error("no offset");
}

/// A wrong offset moves both positions by offset / kp, wherever the reference goes: three of its
/// sd are allowed on top. The deflection and the torque do not see it.
void compare(const Model& fitted, const std::string& preload) {
  const double shift = 3 * offset_sd(fitted) / kProportional;
  const std::vector<std::pair<const char*, double>> signals = {
      {"q", shift}, {"theta", shift}, {"deflection", 0}, {"tau", 0}};
  for (const char* log : kMovingLogs) {
    const std::string name = preload + "/" + log;
    const SimulatedPart fit = simulate_shipped(fitted, name);
    const SimulatedPart truth = simulate_shipped(true_model(preload), name);
    for (const auto& [signal, allowed] : signals) {
      const double gap = gap_of(fit, signal).rms, floor = gap_of(truth, signal).rms;
      std::printf("    %s %s %s: %.3g, %.2f of the true model's\n", fitted.name.c_str(),
                  name.c_str(), signal, gap, gap / floor);
      INFO(name << ": " << signal);
      CHECK(gap < kTimes * floor + allowed);
    }
  }
}

TEST_CASE("a result carries the joint covariance of its parameters", "[simulate]") {
  const Model model = Fitted("low").model("poly");
  const Eigen::MatrixXd& covariance = model.covariance.matrix;
  std::size_t found = 0;
  for (const JointModel& joint : model.joints)
    for (const auto* side : {&joint.link, &joint.motor})
      for (const EffectInstance& effect : *side) {
        const Estimate& e = effect.parameters.front();
        const auto own = model.covariance.of({e.name});
        REQUIRE(own);
        CHECK_THAT(std::sqrt((*own)(0, 0)), Catch::Matchers::WithinRel(e.sd, 1e-9));
        ++found;
      }
  for (const Estimate& e : model.elastic)
    if (const auto own = model.covariance.of({e.name}); own && e.name.front() == 'K') {
      CHECK_THAT(std::sqrt((*own)(0, 0)), Catch::Matchers::WithinRel(e.sd, 1e-9));
      ++found;
    }
  CHECK(found == 11);  // J, f_v, f_s of both sides, offset, two coefficients of two cables
  // Both equations rest on the same curve: what it gets wrong moves their parameters together.
  const auto both = *model.covariance.of({"J_link", "K1_1"});
  CHECK(std::abs(both(0, 1)) > 0);
  const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation =
      sd.cwiseInverse().asDiagonal() * covariance * sd.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  CHECK(eigen.eigenvalues().minCoeff() > -1e-9);
}

TEST_CASE("the model fitted to the low logs simulates them as the true one does", "[simulate]") {
  compare(Fitted("low").model("poly"), "low");
}

TEST_CASE("and that of the high logs, when the preload is known", "[simulate]") {
  // Cables with their initial elongation; without it stage 1 can only fit a curve without the two
  // kinks, see data/README.md.
  const Fitted fitted("high", R"({"preload": "high", "torque_hold": "zoh",
    "load": {"type": "column"},
    "cables": [{"name": "1", "motor_radius": [1], "link_radius": [1], "order": 2,
                "initial_elongation": 0.00512},
               {"name": "2", "motor_radius": [-1], "link_radius": [-1], "order": 2,
                "initial_elongation": 0.004668802}]})");
  compare(fitted.model("poly"), "high");
}

TEST_CASE("a linear spring is far off on the low preload", "[simulate]") {
  // It has one stiffness where the cables go from 1.4 to 4 kN m/rad.
  const Fitted fitted("low");
  for (const char* log : kMovingLogs) {
    const std::string name = std::string("low/") + log;
    const SimulatedPart linear = simulate_shipped(fitted.model("linear"), name);
    const SimulatedPart poly = simulate_shipped(fitted.model("poly"), name);
    CHECK(gap_of(linear, "q").rms > 100 * gap_of(poly, "q").rms);
    CHECK(gap_of(linear, "theta").rms > 100 * gap_of(poly, "theta").rms);
    CHECK(gap_of(linear, "deflection").rms > 100 * gap_of(poly, "deflection").rms);
    CHECK(gap_of(linear, "tau").rms > 3 * gap_of(poly, "tau").rms);
    CHECK(linear.cables.empty());
    CHECK_FALSE(linear.closure_share.has_value());
  }
}

}  // namespace
