// A whole batch: the same whatever the jobs and whatever was there, and what CI reads of it.
#include "cablefit/campaign/batch.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cablefit/base/error.hpp"
#include "cablefit/campaign/batch_json.hpp"
#include "cablefit/report/documents/batch_document.hpp"
#include "cablefit/report/sections/batch_figures.hpp"
#include "cablefit/report/writers/junit.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::TempFolder;

/// The shipped cells at three dates on two robots, the logs being the same.
Campaign fleet() {
  const Campaign shipped = read_campaign(CABLEFIT_DATA "/campaign.json");
  Campaign campaign = shipped;
  campaign.cells.clear();
  for (const char* date : {"2026-01-05", "2026-02-05", "2026-07-05"})
    for (const char* robot : {"arm 1", "arm 2"})
      for (CampaignCell cell : shipped.cells) {
        cell.date = date;
        cell.robot = robot;
        cell.name = cell.robot + " " + cell.preload + " " + cell.date;
        campaign.cells.push_back(cell);
      }
  return campaign;
}

const BatchResult& fitted_fleet() {
  static const BatchResult result = run_batch(fleet(), {});
  return result;
}

TEST_CASE("results are the same with any number of jobs, and when cells are there already") {
  const TempFolder folder;
  const std::string expected = batch_json(fitted_fleet());
  const std::string page = write_text(batch_document(fitted_fleet()));
  for (const int jobs : {1, 3}) {
    BatchOptions options;
    options.jobs = jobs;
    options.folder = folder.file("cells" + std::to_string(jobs));
    std::size_t n_calls = 0;
    options.progress = [&](const BatchProgress& now) {
      ++n_calls;
      CHECK(now.n_done == n_calls);
      CHECK(now.n_cells == 12);
    };
    const BatchResult first = run_batch(fleet(), options);
    CHECK(n_calls == 12);
    n_calls = 0;
    const BatchResult second = run_batch(fleet(), options);
    CHECK(second.n_kept == 12);
    for (const BatchResult* result : {&first, &second}) {
      CHECK((batch_json(*result) == expected));
      CHECK((write_text(batch_document(*result)) == page));
    }
    // The same logs and options twice are one file.
    const auto files = fs::directory_iterator(options.folder);
    CHECK(std::distance(begin(files), end(files)) == 2);
  }
}

TEST_CASE("a cell with refine is told what is missing: nothing, on the shipped logs") {
  Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  campaign.cells.resize(1);
  campaign.cells.front().refine.emplace().n_draws = 4;
  campaign.limits.new_effect = false;
  const BatchResult result = run_batch(campaign, {});
  REQUIRE(result.cells.front().refine);
  CHECK(result.cells.front().refine->error == "");
  CHECK(result.cells.front().refine->verdict == "none");
  CHECK(result.gates.back().name == "new_effect");
  CHECK(result.gates.back().passed);
  CHECK(test::schema_errors("batch", batch_json(result)) == "");
  const auto& tables = batch_document(result).tables;
  CHECK(std::any_of(tables.begin(), tables.end(), [](const Table& table) {
    return table.title == "Missing effects" && table.rows.size() == 1 &&
           table.columns[3].unit == "N m";
  }));
}

TEST_CASE("refine that has no verdict costs no fit") {
  Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  campaign.cells.resize(1);
  CampaignCell& cell = campaign.cells.front();
  const TempFolder folder;
  std::ifstream log(CABLEFIT_DATA "/low/moving_load30.csv");
  std::string text;  // t,q,theta: no torque
  for (std::string line; std::getline(log, line);) {
    std::size_t end = 0;
    for (int comma = 0; comma < 3; ++comma) end = line.find(',', end) + 1;
    text += line.substr(0, end - 1) + '\n';
  }
  cell.rig = CABLEFIT_DATA "/low/rig.json";
  cell.refine.emplace().train = {folder.write("no_torque.csv", text)};
  const BatchResult result = run_batch(campaign, {});
  REQUIRE(result.cells.front().refine);
  CHECK(result.cells.front().error == "");
  CHECK(result.cells.front().dynamic.has_value());
  CHECK(result.cells.front().refine->verdict == "");
  CHECK(result.cells.front().refine->error != "");
  CHECK(test::schema_errors("batch", batch_json(result)) == "");
}

TEST_CASE("one cell writes its own file, from which the batch takes it") {
  const TempFolder folder;
  BatchOptions options;
  options.folder = folder.file("cells");
  const Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  CHECK(run_cell(campaign, "high", options).error.empty());
  CHECK(run_batch(campaign, options).n_kept == 1);
  CHECK(message_of([&] { run_cell(campaign, "hihg", options); }) ==
        "the campaign has no cell 'hihg'; did you mean 'high'?");
}

// Files are kept by number, and the numbers of one layout are not those of another.
TEST_CASE("the same files in another layout keep their names") {
  const TempFolder folder;
  BatchOptions options;
  options.folder = folder.file("cells");
  Campaign together = read_campaign(CABLEFIT_DATA "/campaign.json");
  together.cells.resize(1);
  Campaign apart = together;
  CampaignCell& cell = apart.cells.front();
  const auto copied = [&](const std::string& path, const std::string& place) {
    const fs::path to = fs::path(folder.file(place)) / fs::path(path).filename();
    fs::create_directories(to.parent_path());
    fs::copy_file(path, to, fs::copy_options::overwrite_existing);
    return to.string();
  };
  for (std::string& log : cell.blocked) log = copied(log, "x");
  for (std::string& log : cell.moving) log = copied(log, "y");
  for (const char* place : {"x", "y"}) copied(cell.rig, place);
  cell.rig = "";
  run_batch(together, options);
  const std::string kept = batch_json(run_batch(apart, options));
  CHECK((kept == batch_json(run_batch(apart, {}))));
  CHECK(kept.find("y/moving_load30.csv") != std::string::npos);
}

TEST_CASE("a cell that fails is tried again, and is listed") {
  const TempFolder folder;
  Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  campaign.cells[0].blocked = {folder.write("broken.csv", "t,q,theta,tau\n0,0,0,nonsense\n")};
  campaign.limits.new_effect = false;
  BatchOptions options;
  options.folder = folder.file("cells");
  for (int k = 0; k < 2; ++k) {
    const BatchResult result = run_batch(campaign, options);
    CHECK(result.n_kept == static_cast<std::size_t>(k));  // the other one
    CHECK(test::schema_errors("batch", batch_json(result)) == "");
    const auto json = nlohmann::json::parse(batch_json(result));
    REQUIRE(json["failed"].size() == 1);
    CHECK(json["failed"][0]["cell"] == "low");
    CHECK(json["failed"][0]["code"] == 3);
    CHECK(json["failed"][0]["message"] == result.cells[0].error);
    CHECK(result.cells[0].error.find("broken.csv:2:7: ") != std::string::npos);
    CHECK(json["warnings"].size() == 1);
    CHECK(json["warnings"][0].get<std::string>().starts_with("limits.new_effect is false, but"));
    const Document document = batch_document(result);
    REQUIRE(document.summary.size() == 3);
    CHECK(document.summary[0].text == "1 fitted, 1 failed");
    CHECK(document.summary[1].text == "low: " + result.cells[0].error);
    CHECK(document.summary[2].text == "7 checked, 1 failed");
  }
}

TEST_CASE("a folder that cannot be written costs the cells, not the run") {
  const TempFolder folder;
  BatchOptions options;
  options.folder = folder.write("cells", "a file in its place");
  const BatchResult result = run_batch(read_campaign(CABLEFIT_DATA "/campaign.json"), options);
  for (const BatchCell& cell : result.cells) {
    CHECK(cell.exit_code == 5);
    CHECK(cell.error.starts_with("cannot write " + options.folder + "/"));
    CHECK(!cell.elastic);
  }
}

TEST_CASE("tables call preloads by their cells") {
  const ElasticResult all = fitted_fleet().all_elastic();
  REQUIRE(all.preloads.size() == 12);
  CHECK(all.preloads[0].name == "arm 1 low 2026-01-05");
  Campaign few = fleet();
  few.cells.resize(1);
  const ElasticResult one = run_batch(few, {}).all_elastic();
  CHECK(one.preloads[0].figures.front().section == one.preloads[0].name);
}

TEST_CASE("every parameter is shown against preload and against date") {
  const std::vector<Figure> figures = parameter_figures(fitted_fleet());
  const auto count = [&](const std::string& title, const char* axis) {
    std::size_t n = 0;
    for (const Figure& figure : figures) n += figure.title == title && figure.x.title == axis;
    return n;
  };
  for (const char* name : {"K", "K1_0", "offset", "J_link", "J_motor", "f_v", "f_s", "f_vm"}) {
    INFO(name);
    CHECK(count(name, kPreloadAxis) >= 1);
    CHECK(count(name, kDateAxis) == count(name, kPreloadAxis));
  }
  for (const Figure& figure : figures) {
    if (figure.title != "J_link") continue;
    const bool by_date = figure.x.title == kDateAxis;
    CHECK(figure.traces.size() == (by_date ? 8 : 4));  // models x robots (x preloads)
    CHECK(figure.traces[0].name == (by_date ? "linear, low, arm 1" : "linear, arm 1"));
    CHECK(figure.traces[0].labels.size() == (by_date ? 3 : 6));
    for (std::size_t k = 0; k < figure.traces[0].y.size(); ++k)
      CHECK((figure.traces[0].low[k] < figure.traces[0].y[k] &&
             figure.traces[0].y[k] < figure.traces[0].high[k]));
  }
}

TEST_CASE("JUnit counts tests, failures and errors, and escapes what people call things") {
  BatchResult result;
  result.campaign_name = "a <b> & \"c\"\x01";
  result.cells.resize(2);
  result.cells[0].name = "l<w";
  result.cells[1].name = "\xEF\xBF\xBE";
  result.cells[1].error = "x.csv:3:4: no \"number\"";
  result.gates = {{"rsd_percent f_v", "l<w", 1, 2, false, "FAILED: l<w: 2 > 1"},
                  {"drift K", "l<w", 1, 0, true, "passed"},
                  {kFittedGate, result.cells[1].name, 0, 0, false, "FAILED"}};
  CHECK(junit_xml(result) ==
        R"(<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="a &lt;b&gt; &amp; &quot;c&quot;\x01" tests="4" failures="1" errors="1">
  <testsuite name="l&lt;w" tests="3" failures="1" errors="0">
    <testcase classname="l&lt;w" name="fitted"/>
    <testcase classname="l&lt;w" name="rsd_percent f_v">
      <failure message="FAILED: l&lt;w: 2 &gt; 1"/>
    </testcase>
    <testcase classname="l&lt;w" name="drift K"/>
  </testsuite>
  <testsuite name="?" tests="1" failures="0" errors="1">
    <testcase classname="?" name="fitted">
      <error message="x.csv:3:4: no &quot;number&quot;"/>
    </testcase>
  </testsuite>
</testsuites>
)");
}

}  // namespace
}  // namespace cablefit
