#include "real.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/support/temp_folder.hpp"

using namespace hidden;

TEST_CASE("a parabola is given back exactly, on an uneven clock") {
  Eigen::VectorXd t(40), x(40);
  for (int k = 0; k < 40; ++k) {
    t[k] = 0.01 * k + 0.003 * (k % 3);
    x[k] = 1 + 2 * t[k] + 3 * t[k] * t[k];
  }
  const Track found = track(t, x, 5);
  CHECK((found.x - x).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((found.v.array() - 2 - 6 * t.array()).abs().maxCoeff() < 1e-9);
  CHECK((found.a.array() - 6).abs().maxCoeff() < 1e-6);
}

TEST_CASE("planting changes tau by the torque asked for, and nothing else") {
  const std::filesystem::path data = CABLEFIT_SHARED_DATA;
  if (!std::filesystem::exists(data / "emps")) {
    std::cout << "SKIPPED: no real logs in " << data << '\n';
    return;
  }
  for (const RealSet& set : real_sets())
    for (const RealEffect& effect : real_effects()) {
      if (!(set.blocked ? effect.blocked : effect.moving)) continue;
      INFO(set.name << ' ' << effect.name);
      const cablefit::test::TempFolder folder;
      plant_real(data, {std::string(set.name), std::string(effect.name), 0.5, 1}, folder.path());
      const auto truth = nlohmann::json::parse(std::ifstream(folder.file("truth.json")));
      double square = 0, n = 0;
      for (const std::string_view file : set.train) {
        const RealLog before = read_log(data / set.folder / file);
        const RealLog after = read_log(folder.path() / file);
        REQUIRE(before.names == after.names);
        const Eigen::VectorXd added = after.column("tau") - before.column("tau");
        square += added.squaredNorm();
        n += static_cast<double>(added.size());
        for (const std::string& name : before.names)
          if (name != "tau") CHECK(before.column(name) == after.column(name));
      }
      const double gap = truth["gap_before_planting"];
      CHECK(std::abs(std::sqrt(square / n) / (0.5 * gap) - 1) < 1e-6);
      CHECK(truth["ratio_unabsorbed"] > 0.05);
    }
}

TEST_CASE("a set that is not there, and logs that are not there") {
  const cablefit::test::TempFolder folder;
  CHECK_THROWS_WITH(plant_real(".", {"empss", "stribeck"}, folder.path()),
                    "no set of real logs 'empss'; there are: emps sea xl330");
  CHECK_THROWS_WITH(plant_real(".", {"sea", "stribeck"}, folder.path()),
                    "stribeck cannot be seen in sea");
  CHECK_THROWS_WITH(plant_real(folder.path(), {"emps", "stribeck"}, folder.path()),
                    Catch::StartsWith("cannot read "));
}
