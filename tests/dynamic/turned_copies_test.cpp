// The copies that the floor of the method is measured by: joints are turned aside so that the
// encoders round otherwise, but not against cables that pass several joints.
#include <optional>

#include "cablefit/dynamic/loops/method_floor.hpp"
#include "cablefit/dynamic/rows/joint_settings.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kCount = 1.2e-5;  // of the shipped encoders, rad

/// Means over all rows of the positions of both joints: q1, q2, theta1, theta2.
Eigen::Vector4d mean_positions(const LogSurvey& log) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  double n = 0;
  Eigen::MatrixXd rows;  // as [t, slots]
  for (const SamplePiece& piece : log.samples->pieces()) {
    log.samples->read(piece, rows);
    for (int joint = 0; joint < 2; ++joint) {
      sum(joint) += rows.col(1 + log.plan.find(Channel::q, joint)).sum();
      sum(2 + joint) += rows.col(1 + log.plan.find(Channel::theta, joint)).sum();
    }
    n += static_cast<double>(rows.rows());
  }
  return sum / n;
}

TEST_CASE("copies that are turned aside do not stretch coupled cables", "[dynamic]") {
  const std::vector<LogSurvey> logs{shipped("two_joints/pairs/moving.csv")};
  const std::vector<LogSurvey> blocked{shipped("two_joints/pairs/blocked.csv")};
  const ElasticResult stage1 = fit_elastic_stage(blocked, {}, ElongationMode::automatic);
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = "wls";
  const TempFolder folder;
  std::string choice;
  const Model model =
      read_model(folder.write("dynamic.json", dynamic_json(fit_dynamic(logs, stage1, options))), "",
                 "", choice);
  DynamicJob job{logs,
                 options,
                 "default",
                 [](const PartSurvey& /*any*/) { return true; },
                 {stage1.preloads.front().find("poly")},
                 {"poly"},
                 false,
                 {},
                 {}};
  choose_joint_settings(job, {}, {100, 100});
  std::optional<Eigen::Vector4d> exact;
  double farthest = 0;
  CopyDraws(job, model, true, true).for_each([&](const CopyDraw& draw) {
    REQUIRE(draw.logs.size() == 1);
    const Eigen::Vector4d mean = mean_positions(draw.logs.front());
    if (!exact) exact = mean;
    CHECK(draw.exact == (mean == *exact));
    const Eigen::Vector4d turn = (mean - *exact) / kCount;  // counts
    farthest = std::max(farthest, turn.cwiseAbs().maxCoeff());
    // Pulleys of both pairs, data/README.md: 3 cm on motor and link 1; 2 cm on motor and link 2,
    // and 1 cm on link 1. The mean over 8000 rows knows what rounding does to 0.01 counts.
    CHECK(std::abs(0.03 * turn(2) - 0.03 * turn(0)) < 0.03 * 0.05);
    CHECK(std::abs(0.02 * turn(3) - 0.01 * turn(0) - 0.02 * turn(1)) < 0.02 * 0.05);
  });
  CHECK(farthest > 1);  // up to 16
}

}  // namespace
