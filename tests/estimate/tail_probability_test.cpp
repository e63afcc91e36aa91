// Tail probabilities against R.
#include "cablefit/estimate/spread/tail_probability.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

// R 4.2.2, pchisq(x, dof, lower.tail = FALSE): {x, dof, p}.
constexpr double kChiSquared[][3] = {
    {3.84, 1, 0.050043521248705224}, {31.4, 20, 0.050126415353420821},
    {5, 20, 0.99972264790537912},    {400, 20, 2.0440955935807322e-72},
    {0.01, 3, 0.99973483494134441},  {150, 120, 0.03307348091130468},
};
// R 4.2.2, pf(x, dof1, dof2, lower.tail = FALSE): {x, dof1, dof2, p}.
constexpr double kF[][4] = {
    {4, 1, 10, 0.073388034770740393},    {2.5, 7, 200.5, 0.017493330461971511},
    {30, 5, 60, 3.8525414699931549e-15}, {0.2, 3, 8.25, 0.89358465164795431},
    {1, 40, 40, 0.50000000000000044},    {900, 2, 1000, 2.6362362579932034e-224},
};

// R 4.2.2, qt(p / 2, dof, lower.tail = FALSE): {p, dof, x}.
constexpr double kT[][3] = {
    {0.05, 10, 2.2281388519862744},
    {0.01, 3, 5.8409093097333562},
    {0.05 / 14, 200.5, 2.948583550593515},
    {1e-6, 60, 5.4489478322860689},
};

// lgamma of 500 loses three of sixteen digits as the exponent of its result: 1e-10 leaves room.
TEST_CASE("tails of chi-squared are those of R", "[estimate]") {
  for (const auto& [x, dof, p] : kChiSquared)
    CHECK_THAT(chi_squared_tail(x, dof), Catch::WithinRel(p, 1e-10));
  CHECK(chi_squared_tail(0, 3) == 1);
}

TEST_CASE("tails of F are those of R", "[estimate]") {
  for (const auto& [x, dof_1, dof_2, p] : kF)
    CHECK_THAT(f_tail(x, dof_1, dof_2), Catch::WithinRel(p, 1e-10));
  CHECK(f_tail(-1, 3, 5) == 1);
}

TEST_CASE("quantiles of Student's t are those of R", "[estimate]") {
  for (const auto& [p, dof, x] : kT) {
    CHECK_THAT(t_quantile(p, dof), Catch::WithinRel(x, 1e-10));
    CHECK_THAT(t_tail(x, dof), Catch::WithinRel(p, 1e-8));
  }
}

}  // namespace
