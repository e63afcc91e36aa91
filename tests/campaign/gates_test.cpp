// Gates: what passes, what fails, and that a baseline 20 % off fails every drift gate.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cablefit/campaign/batch.hpp"
#include "cablefit/campaign/batch_json.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

using test::TempFolder;

const BatchResult& shipped() {
  static const BatchResult result = run_batch(read_campaign(CABLEFIT_DATA "/campaign.json"), {});
  return result;
}

/// The shipped result as a baseline, every value multiplied.
std::string baseline(const TempFolder& folder, double factor) {
  auto json = nlohmann::json::parse(batch_json(shipped()));
  for (auto& cell : json["cells"])
    for (const char* stage : {"elastic", "dynamic"})
      for (auto& preload : cell[stage]["preloads"])
        for (auto& fit : preload["fits"])
          for (auto& parameter : fit["parameters"])
            if (parameter["value"].is_number())
              parameter["value"] = parameter["value"].get<double>() * factor;
  const std::string path = folder.file("baseline.json");
  std::ofstream(path) << json;
  return path;
}

Campaign with_baseline(const std::string& path) {
  Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  campaign.limits = {};
  campaign.limits.drift_baseline = path;
  campaign.limits.drift_percent = 15;
  return campaign;
}

std::size_t failed(const std::vector<Gate>& gates) {
  std::size_t n = 0;
  for (const Gate& gate : gates) n += !gate.passed;
  return n;
}

TEST_CASE("the shipped campaign passes its own limits") {
  REQUIRE(shipped().cells.size() == 2);
  for (const BatchCell& cell : shipped().cells) CHECK(cell.error.empty());
  // Six physical parameters in each of two cells; the offset has no lower bound and no gate.
  CHECK(shipped().gates.size() == 12);
  CHECK(failed(shipped().gates) == 0);
}

TEST_CASE("a baseline of the same result passes, one 20 % off fails everywhere") {
  const TempFolder folder;
  const auto same = judge(with_baseline(baseline(folder, 1.0)), shipped().cells);
  CHECK(same.size() == 26);  // K, four coefficients, f_sm, f_vm and six of stage 2 per cell
  CHECK(failed(same) == 0);
  const auto off = judge(with_baseline(baseline(folder, 1.2)), shipped().cells);
  CHECK(failed(off) == off.size());
  for (const Gate& gate : off) CHECK(gate.value == Approx(100 * 0.2 / 1.2).epsilon(1e-9));
}

TEST_CASE("a limit below what the fit leaves fails, one line each") {
  Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  campaign.limits = {};
  campaign.limits.torque_error = 1e-3;  // N m; the torque noise alone leaves about 0.2
  const auto gates = judge(campaign, shipped().cells);
  CHECK(gates.size() == 4);
  CHECK(failed(gates) == 4);
  for (const Gate& gate : gates) CHECK(gate.text.find('\n') == std::string::npos);
}

TEST_CASE("a cell that cannot be fitted does not stop the others") {
  const TempFolder folder;
  const std::string broken = folder.file("broken.csv");
  std::ofstream(broken) << "t,q,theta,tau\n0,0,0,nonsense\n";
  Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  campaign.cells[0].blocked = {broken};
  const BatchResult result = run_batch(campaign, {});
  CHECK(result.cells[0].exit_code == 3);
  CHECK(result.cells[0].error.find("broken.csv:2:7") != std::string::npos);
  CHECK(result.cells[1].error.empty());
  CHECK(result.cells[1].dynamic.has_value());
}

BatchCell refined(const CellRefine& refine) {
  BatchCell cell = shipped().cells.front();
  cell.refine = refine;
  return cell;
}

TEST_CASE("a new effect fails its gate only where the campaign forbids it") {
  CellRefine named, none, unknown;
  named.verdict = "ambiguous";
  named.effects = {{"stribeck", "motor", 0.5, 0.0012, 1, {}}};
  none.verdict = "none";
  unknown.error = "too short";
  const std::vector<BatchCell> cells = {refined(named), refined(none), refined(unknown),
                                        shipped().cells.front()};
  Campaign campaign = with_baseline("");
  CHECK(judge(campaign, cells).empty());
  campaign.limits.new_effect = false;
  const auto gates = judge(campaign, cells);
  REQUIRE(gates.size() == 3);
  CHECK(gates[0].text ==
        "FAILED: low: new_effect: refine identified stribeck (motor side, p = 0.0012), "
        "verdict 'ambiguous'");
  CHECK(gates[1].text == "passed: low: new_effect: refine identified none, verdict 'none'");
  CHECK(gates[2].text == "FAILED: low: new_effect: refine has no verdict: too short");
  CHECK((!gates[0].passed && gates[1].passed && !gates[2].passed));
}

TEST_CASE("drift is against the cell of the same name, else the latest of the same robot") {
  const TempFolder folder;
  auto json = nlohmann::json::parse(batch_json(shipped()));
  const auto cell = json["cells"][0];
  json["cells"].clear();
  const auto add = [&](const char* name, const char* robot, const char* date, double factor) {
    auto copy = cell;
    copy["name"] = name;
    copy["robot"] = robot;
    copy["date"] = date;
    for (auto& fit : copy["elastic"]["preloads"][0]["fits"])
      for (auto& parameter : fit["parameters"])
        parameter["value"] = parameter["value"].get<double>() * factor;
    json["cells"].push_back(copy);
  };
  add("spring", "a", "2026-03-01", 2);
  add("autumn", "a", "2026-09-01", 4);
  add("summer", "a", "2026-06-01", 8);
  add("other", "b", "2027-01-01", 16);
  const std::string path = folder.write("baseline.json", json.dump());
  const auto drift_of_K = [&](const char* name, const char* robot) {
    BatchCell now = shipped().cells.front();
    now.name = name;
    now.robot = robot;
    return judge(with_baseline(path), {now}).front().value;
  };
  CHECK(drift_of_K("spring", "a") == Approx(50));
  CHECK(drift_of_K("winter", "a") == Approx(75));
  CHECK(drift_of_K("winter", "b") == Approx(100 * 15. / 16));
  CHECK(std::isnan(drift_of_K("winter", "c")));
}

TEST_CASE("parameters of several joints have gates too") {
  BatchCell cell = shipped().cells.front();
  for (DynamicFit& fit : cell.dynamic->preloads.front().fits)
    for (Estimate& e : fit.parameters) e.name += "[2]";
  Campaign campaign = with_baseline("");
  campaign.limits.rsd_percent = 1e-9;
  CHECK(judge(campaign, {cell}).size() == 6);
}

}  // namespace
}  // namespace cablefit
