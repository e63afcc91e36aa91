// The covariance of the parameters of several joints, in a result and in the model that is read
// from it.
#include <Eigen/Eigenvalues>

#include "cablefit/model/arm/urdf_file.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

DynamicResult fit_of(const std::string& folder) {
  const ElasticResult stage1 =
      fit_elastic(std::vector<LogSurvey>{shipped(folder + "/blocked.csv")}, {});
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = "wls";
  return fit_dynamic(std::vector<LogSurvey>{shipped(folder + "/moving.csv")}, stage1, options);
}

/// Correlations have 1 on the diagonal, so that rounding is some times 1e-16.
void check_is_covariance(const Eigen::MatrixXd& c) {
  const Eigen::VectorXd sd = c.diagonal().cwiseSqrt();
  const Eigen::MatrixXd r = sd.cwiseInverse().asDiagonal() * c * sd.cwiseInverse().asDiagonal();
  CHECK((r - r.transpose()).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(r).eigenvalues()(0) > -1e-10);
}

TEST_CASE("the parameters of several joints have a joint covariance", "[dynamic]") {
  for (const std::string name : {"finger", "phalanges"}) {
    if (name == "phalanges" && !reads_urdf()) continue;
    INFO(name);
    const DynamicResult result = fit_of("two_joints/" + name);
    const DynamicFit& found = result.preloads.at(0).fits.at(0);
    const ParameterCovariance& c = found.covariance;
    REQUIRE_FALSE(c.empty());
    check_is_covariance(c.matrix);
    // Its diagonal is what the table says, of every parameter of both joints.
    for (const Estimate& e : found.parameters) {
      INFO(e.name);
      const auto variance = c.of({e.name});
      REQUIRE(variance);
      CHECK_THAT(std::sqrt((*variance)(0, 0)), Catch::WithinRel(e.sd, 1e-9));
    }
    // A cable's coefficient and what stage 2 makes of it are one error (Murphy & Topel 1985).
    const auto both = c.of({"k[flexor]_0", "offset[1]"});
    REQUIRE(both);
    CHECK((*both)(0, 1) != 0);
    // The model of the result has the same.
    const TempFolder folder;
    std::string choice;
    const Model model =
        read_model(folder.write("dynamic.json", dynamic_json(result)), "", "", choice);
    CHECK(model.covariance.parameters == c.parameters);
    CHECK(model.covariance.matrix == c.matrix);
  }
}

}  // namespace
