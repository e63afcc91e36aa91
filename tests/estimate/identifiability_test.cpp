// Which parameters rows separate, in words. The test makes every direction itself.
#include "cablefit/estimate/solve/identifiability.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/model/effects.hpp"
#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using test::Normal;

constexpr Eigen::Index kRows = 400;

NamedColumn column(const char* name, MotionPart part) {
  return {name, {part, std::string(motion_unit(part, Axes::rotary))}};
}

const std::vector<NamedColumn> kRigid = {
    column("J", MotionPart::acceleration), column("f_v", MotionPart::velocity),
    column("f_s", MotionPart::direction), column("offset", MotionPart::constant)};

/// Acceleration, velocity, direction and 1 of independent accelerations and speeds.
Eigen::MatrixXd rigid_rows(std::uint64_t seed) {
  Normal normal(seed);
  Eigen::MatrixXd w(kRows, 4);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double speed = normal();
    w.row(i) << 3 * normal(), speed, test::sign(speed), 1;
  }
  return w;
}

std::vector<std::string> texts(const Identifiability& found) {
  std::vector<std::string> all;
  for (const Confusion& confusion : found.confusions) all.push_back(confusion.text);
  return all;
}

using Texts = std::vector<std::string>;

TEST_CASE("rich motion confuses nothing, and sd per unit of noise is the textbook's",
          "[estimate]") {
  const Eigen::MatrixXd w = rigid_rows(6401);
  const Identifiability found = identifiability(w, kRows, kRigid);
  CHECK(texts(found) == Texts{});
  CHECK(found.condition_scaled < 10);
  const Eigen::MatrixXd inverse = (w.transpose() * w).inverse();
  for (Eigen::Index k = 0; k < 4; ++k)
    CHECK(found.unit_sd(k) == Approx(std::sqrt(inverse(k, k))).epsilon(1e-10));
  CHECK(found.correlation(1, 2) ==
        Approx(inverse(1, 2) / std::sqrt(inverse(1, 1) * inverse(2, 2))).epsilon(1e-10));
}

TEST_CASE("at one speed viscous and dry friction are one, told with the speed", "[estimate]") {
  Eigen::MatrixXd w = rigid_rows(6402);
  w.col(1) = 0.5 * w.col(2);
  const Identifiability found = identifiability(w, kRows, kRigid);
  CHECK(texts(found) ==
        Texts{"f_v and f_s are not separable: correlation -1.000, only f_s + 0.5 f_v shows; move "
              "at several speeds, slow and fast (a speed ladder); now 0.5 rad/s rms"});
  CHECK(found.confusions[0].exact);
  CHECK(std::isinf(found.unit_sd(1)));
  CHECK(std::isinf(found.unit_sd(2)));
  CHECK(std::isfinite(found.unit_sd(0)));
  CHECK(found.correlation(1, 2) == 0);
}

TEST_CASE("in one direction dry friction and the offset are one", "[estimate]") {
  Eigen::MatrixXd w = rigid_rows(6403);
  w.col(1) = w.col(1).cwiseAbs();
  w.col(2).setOnes();
  CHECK(texts(identifiability(w, kRows, kRigid)) ==
        Texts{"f_s and offset are not separable: correlation -1.000, only offset + 1 f_s shows; "
              "move in both directions"});
}

TEST_CASE("what is never excited is said to be so", "[estimate]") {
  Eigen::MatrixXd w = rigid_rows(6404);
  w.col(0).setZero();
  CHECK(texts(identifiability(w, kRows, kRigid)) ==
        Texts{"J is not determined: these logs do not excite it; change the speed"});
}

// The two null directions come out of the singular values as any mixture of both.
TEST_CASE("two confusions at once are told one by one", "[estimate]") {
  Eigen::MatrixXd w = rigid_rows(6405);
  w.col(0) *= 3 * std::sqrt(kRows) / w.col(0).norm();  // 3 rms
  w.col(1) = -2 * w.col(0);
  w.col(2).setOnes();
  CHECK(texts(identifiability(w, kRows, kRigid)) ==
        Texts{"J and f_v are not separable: correlation 1.000, only f_v - 0.5 J shows; reverse "
              "harder, and hold speeds between reversals; now 3 rad/s^2 rms",
              "f_s and offset are not separable: correlation -1.000, only offset + 1 f_s shows; "
              "move in both directions"});
}

TEST_CASE("three columns in one line are told in pairs", "[estimate]") {
  Eigen::MatrixXd w = rigid_rows(6410);
  w.col(1) = w.col(0);
  w.col(2) = -w.col(0);
  const Identifiability found = identifiability(w, kRows, kRigid);
  REQUIRE(found.confusions.size() == 2);
  for (const Confusion& confusion : found.confusions) CHECK(confusion.members.size() == 2);
}

TEST_CASE("directions are reduced to the fewest parameters, whatever their mixture", "[estimate]") {
  const double h = std::sqrt(0.5);
  Eigen::MatrixXd pure = Eigen::MatrixXd::Zero(5, 2);
  pure.col(0) << h, 0, -h, 0, 0;
  pure.col(1) << 0, 0, 0, h, h;
  Eigen::Matrix2d turn;
  turn << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  const Eigen::MatrixXd found = sparse_directions(pure * turn);
  for (Eigen::Index d = 0; d < 2; ++d) {
    const Eigen::VectorXd along = (pure.transpose() * found.col(d)).cwiseAbs();
    CHECK(along.maxCoeff() == Approx(1).epsilon(1e-12));
    CHECK(along.minCoeff() < 1e-12);
  }
}

TEST_CASE("a correlation above 0.95 is told with what would lower it", "[estimate]") {
  Eigen::MatrixXd w = rigid_rows(6406);
  Normal normal(6407);
  for (Eigen::Index i = 0; i < kRows; ++i) w(i, 1) = 0.5 * w(i, 2) + 0.05 * normal();
  const Identifiability found = identifiability(w, kRows, kRigid);
  REQUIRE(found.confusions.size() == 1);
  const Confusion& pair = found.confusions[0];
  // Regressors of correlation 1/sqrt(1.01); the estimates have it with a minus.
  CHECK(pair.correlation == Approx(-1 / std::sqrt(1.01)).margin(0.002));
  CHECK(pair.text ==
        fmt::format("f_v and f_s are strongly correlated: {:.3f}; move at "
                    "several speeds, slow and fast (a speed ladder); now 0.5 rad/s rms",
                    pair.correlation));
  CHECK_FALSE(pair.exact);
  // Half the correlation is no confusion.
  for (Eigen::Index i = 0; i < kRows; ++i) w(i, 1) = 0.5 * w(i, 2) + 0.5 * normal();
  CHECK(texts(identifiability(w, kRows, kRigid)) == Texts{});
}

// No pair correlates by more than 0.95, all three together do: only a condition index shows it.
TEST_CASE("three that lean on each other are told although no two do", "[estimate]") {
  Normal normal(6408);
  Eigen::MatrixXd w(kRows, 5);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    w.row(i) << normal(), normal(), normal(), 0, normal();
    w(i, 3) = w(i, 0) + w(i, 1) + w(i, 2) + 0.02 * normal();
  }
  const std::vector<NamedColumn> names = {{"a"}, {"b"}, {"c"}, {"d"}, {"e"}};
  const Identifiability found = identifiability(w, kRows, names);
  REQUIRE_FALSE(found.confusions.empty());
  const Confusion& group = found.confusions.back();
  CHECK(group.members == std::vector<std::size_t>{0, 1, 2, 3});
  CHECK(group.condition_index == Approx(found.condition_scaled));
  CHECK(group.text == fmt::format("a, b, c and d are strongly correlated: mostly combinations of "
                                  "them are determined (condition index {:.0f})",
                                  group.condition_index));
  w.col(3) = w.col(0) + w.col(1) + w.col(2);
  CHECK(texts(identifiability(w, kRows, names)) ==
        Texts{"a, b, c and d are not separable: only combinations of them are determined"});
}

TEST_CASE("the triangular factor says what the rows say", "[estimate]") {
  Eigen::MatrixXd w = rigid_rows(6409);
  w.col(1) = 0.5 * w.col(2);
  const Eigen::MatrixXd r = w.householderQr().matrixQR().topRows(4).triangularView<Eigen::Upper>();
  CHECK(texts(identifiability(r, kRows, kRigid)) == texts(identifiability(w, kRows, kRigid)));
}

TEST_CASE("any two effects of one side have advice, whichever comes first", "[estimate]") {
  for (const Side side : {Side::link, Side::motor, Side::rigid})
    for (const Effect& a : base_effects(side))
      for (const Effect& b : base_effects(side)) {
        if (&a == &b) continue;
        const MotionColumn one{a.follows, std::string(motion_unit(a.follows, Axes::rotary))};
        const MotionColumn other{b.follows, std::string(motion_unit(b.follows, Axes::rotary))};
        const std::string advice = separating_motion(one, 2, other, 3);
        INFO(a.name << " and " << b.name << ": " << advice);
        CHECK_FALSE(advice.empty());
        CHECK(advice == separating_motion(other, 3, one, 2));
      }
}

TEST_CASE("advice says how much more, where more of it is what helps", "[estimate]") {
  CHECK(stronger_motion({MotionPart::acceleration, "rad/s^2"}, 3.1, 0.5) ==
        "accelerate with 16 rad/s^2 rms or more (now 3.1)");
  CHECK(stronger_motion({MotionPart::velocity, "m/s"}, 0.2, 0.2) ==
        "move at 0.4 m/s rms or more (now 0.2)");
  // sd of what has no size to enlarge falls with the root of the length.
  CHECK(stronger_motion({MotionPart::constant, ""}, 1, 0.3) == "record 9 times as long");
  CHECK(separating_motion({MotionPart::velocity, ""}, 1, {MotionPart::direction, ""}, 1) ==
        "move at several speeds, slow and fast (a speed ladder)");
}

}  // namespace
