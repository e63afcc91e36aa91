// Elastic quantities along positions against closed forms.
#include "cablefit/predict/elastic_prediction.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kFirst = 1400, kCurve = 40000, kSecond = 1600;  // N m/rad, N m/rad^2, N m/rad

/// Two cables of second order, one joint.
Model two_cables() {
  Model model = spring_joint({0.3, 5, 3}, {0.01, 1, 2, 0.5}, 0);
  model.transmission = antagonist_pair(2);
  model.transmission.cables[0].coefficients = {kFirst, kCurve};
  model.transmission.cables[1].coefficients = {kSecond, 0};
  return model;
}

Eigen::Index column_of(const ElasticPrediction& prediction, const std::string& name) {
  for (std::size_t k = 0; k < prediction.signals().size(); ++k)
    if (prediction.signals()[k].name == name) return static_cast<Eigen::Index>(k);
  throw std::runtime_error("no signal " + name);
}

/// q = 0 and these deflections.
ElasticPrediction::Rows rows_at(const ElasticPrediction& prediction, double first, double second) {
  Eigen::ArrayXXd theta(2, 1);
  theta << first, second;
  return prediction.rows(Eigen::ArrayXXd::Zero(2, 1), theta);
}

TEST_CASE("torques, elongations, tensions and energy of an antagonist pair", "[predict]") {
  const ElasticPrediction prediction(two_cables(), true);
  CHECK_FALSE(prediction.has_band());
  const double phi = 0.01;
  const ElasticPrediction::Rows rows = rows_at(prediction, phi, -phi);
  const auto value = [&](Eigen::Index row, const std::string& name) {
    return rows.values(row, column_of(prediction, name));
  };
  // Deflected upwards the first cable pulls alone, downwards the second one.
  const double pull = kFirst * phi + kCurve * phi * phi;
  CHECK_THAT(value(0, "tau_elas_m"), WithinRel(pull, 1e-12));
  CHECK_THAT(value(0, "tau_elas_l"), WithinRel(pull, 1e-12));
  CHECK_THAT(value(0, "elongation[1]"), WithinRel(phi, 1e-12));
  CHECK_THAT(value(0, "elongation[2]"), WithinRel(-phi, 1e-12));
  CHECK_THAT(value(0, "tension[1]"), WithinRel(pull, 1e-12));
  CHECK(value(0, "tension[2]") == 0);
  CHECK_THAT(value(0, "energy"),
             WithinRel(kFirst * phi * phi / 2 + kCurve * phi * phi * phi / 3, 1e-12));
  CHECK_THAT(value(1, "tau_elas_m"), WithinRel(-kSecond * phi, 1e-12));
  CHECK_THAT(value(1, "energy"), WithinRel(kSecond * phi * phi / 2, 1e-12));
}

TEST_CASE("a band follows from the covariance of the coefficients", "[predict]") {
  Model model = two_cables();
  const double sd_first = 5, sd_curve = 300, r = -0.7;
  model.covariance.parameters = {"J_link", "K1_0", "K1_1"};
  model.covariance.matrix.resize(3, 3);
  const double both = r * sd_first * sd_curve;
  model.covariance.matrix << 1e-4, 0.01, 0, 0.01, sd_first * sd_first, both, 0, both,
      sd_curve * sd_curve;
  const ElasticPrediction prediction(model, true);
  REQUIRE(prediction.has_band());
  const double phi = 0.01;
  const ElasticPrediction::Rows rows = rows_at(prediction, phi, -phi);
  const auto half_width = [&](Eigen::Index row, const std::string& name) {
    return rows.half_widths(row, column_of(prediction, name));
  };
  // Linear in the coefficients, so that the copies give it exactly. J_link moves no elastic torque.
  const double by_first = phi * sd_first, by_curve = phi * phi * sd_curve;
  const double sd =
      std::sqrt(by_first * by_first + by_curve * by_curve + 2 * r * by_first * by_curve);
  CHECK_THAT(half_width(0, "tau_elas_m"), WithinRel(1.959964 * sd, 1e-6));
  CHECK_THAT(half_width(0, "tension[1]"), WithinRel(1.959964 * sd, 1e-6));
  CHECK(half_width(0, "elongation[1]") == 0);
  CHECK(half_width(1, "tau_elas_m") == 0);  // the second cable is sure
}

TEST_CASE("a linear spring has torques and energy, and no cables", "[predict]") {
  const ElasticPrediction prediction(spring_joint({0.3, 5, 3}, {0.01, 1, 2, 0}, 1000), true);
  const ElasticPrediction::Rows rows = rows_at(prediction, 0.02, 0);
  CHECK(prediction.signals().size() == 3);
  CHECK_THAT(rows.values(0, column_of(prediction, "tau_elas_l")), WithinRel(20, 1e-12));
  CHECK_THAT(rows.values(0, column_of(prediction, "energy")), WithinRel(0.2, 1e-12));
  CHECK_THAT(rows.values(1, column_of(prediction, "tau_elas_l")), WithinAbs(0, 1e-15));
}

}  // namespace
