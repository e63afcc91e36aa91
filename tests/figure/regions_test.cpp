// Where the names of a map's regions stand.
#include "cablefit/figure/regions.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

const std::vector<std::string> kNames = {"out", "in"};

/// 21 x 11 nodes at (i, 10 j); two squares of "in": nodes 3..7 x 3..7 and 14..18 x 3..7.
Eigen::ArrayXXi two_squares() {
  Eigen::ArrayXXi kinds = Eigen::ArrayXXi::Zero(21, 11);
  kinds.block(3, 3, 5, 5).setOnes();
  kinds.block(14, 3, 5, 5).setOnes();
  return kinds;
}

std::vector<Note> notes(const Eigen::ArrayXXi& kinds, int least_depth) {
  return region_notes(Eigen::VectorXd::LinSpaced(21, 0, 20), Eigen::VectorXd::LinSpaced(11, 0, 100),
                      kinds, kNames, least_depth);
}

bool has(const std::vector<Note>& all, double x, double y, const std::string& text) {
  for (const Note& note : all)
    if (note.x == x && note.y == y && note.text == text) return true;
  return false;
}

TEST_CASE("every region has its name once, in its middle") {
  const std::vector<Note> all = notes(two_squares(), 1);
  CHECK(all.size() == 3);
  CHECK(has(all, 5, 50, "in"));
  CHECK(has(all, 16, 50, "in"));
  CHECK(has(all, 10, 50, "out"));  // between the squares: 8..13, the deepest nearest to the middle
}

TEST_CASE("a region without room has no name") {
  Eigen::ArrayXXi kinds = two_squares();
  CHECK(notes(kinds, 3).size() == 3);  // squares of 5 are 3 deep, and so is the way between them
  CHECK(notes(kinds, 4).empty());
  kinds.block(14, 3, 5, 5).setZero();
  const std::vector<Note> wide = notes(kinds, 4);
  REQUIRE(wide.size() == 1);
  CHECK(wide[0].text == "out");
  CHECK(wide[0].x > 7);
}

TEST_CASE("a map of one kind has one name, in the middle") {
  const std::vector<Note> all = notes(Eigen::ArrayXXi::Zero(21, 11), 1);
  REQUIRE(all.size() == 1);
  CHECK(has(all, 10, 50, "out"));
}

}  // namespace
