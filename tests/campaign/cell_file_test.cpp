// A cell's file: every output made from what it keeps is the output made from the fit itself, it
// does not depend on where the campaign lies, and it is not taken for another cell's.
#include "cablefit/campaign/cells/cell_file.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>

#include "cablefit/base/error.hpp"
#include "cablefit/campaign/batch_json.hpp"
#include "cablefit/campaign/cells/cell_fit.hpp"
#include "cablefit/campaign/cells/portable_text.hpp"
#include "cablefit/model/arm/urdf_file.hpp"
#include "cablefit/report/documents/batch_document.hpp"
#include "cablefit/report/page/page_parts.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using test::message_of;
using test::TempFolder;

Campaign shipped() { return read_campaign(CABLEFIT_DATA "/campaign.json"); }

/// One cell as a whole batch, so that everything that can be said of it is.
BatchResult batch_of(const CampaignCell& cell, const CellResults& results) {
  BatchResult batch;
  BatchCell& only = batch.cells.emplace_back();
  static_cast<CellResults&>(only) = results;
  only.name = cell.name;
  only.preload = cell.preload;
  return batch;
}

void check_same_outputs(const CampaignCell& cell, const CellResults& fitted,
                        const CellResults& kept) {
  const BatchResult a = batch_of(cell, fitted), b = batch_of(cell, kept);
  CHECK(batch_json(a) == batch_json(b));
  const Document first = batch_document(a), second = batch_document(b);
  CHECK(first.figures.size() == second.figures.size());
  for (const ReportWriter& writer : report_writers()) {
    if (writer.name == "html" && !page_parts::built_in()) continue;
    INFO(writer.name);
    CHECK((writer.write(first) == writer.write(second)));  // pages are too long to print
  }
}

TEST_CASE("what a file keeps says what the fit said, for every estimator") {
  for (const char* estimator : {"auto", "wls", "robust", "recursive", "output-error"}) {
    INFO(estimator);
    Campaign campaign = shipped();
    campaign.estimator = estimator;
    CampaignCell& cell = campaign.cells.front();
    cell.validation = {cell.moving.back()};
    cell.moving.pop_back();
    const CellKey key = key_of(campaign, cell, {});
    const CellResults fitted = fit_cell(campaign, cell, key, {});
    REQUIRE(fitted.dynamic.has_value());
    CHECK(!fitted.elastic->preloads.front().figures.empty());
    CHECK(fitted.dynamic->preloads.front().validation.has_value());
    const std::string text = cell_text(fitted, key);
    check_same_outputs(cell, fitted, parse_cell(text, key));
    CHECK((cell_text(parse_cell(text, key), key) == text));
  }
}

TEST_CASE("cables on pulleys come back") {
  Campaign campaign = shipped();
  CampaignCell& high = campaign.cells.back();
  high.rig = CABLEFIT_DATA "/high/rig_cables.json";
  const CellKey key = key_of(campaign, high, {});
  const CellResults fitted = fit_cell(campaign, high, key, {});
  check_same_outputs(high, fitted, parse_cell(cell_text(fitted, key), key));
}

TEST_CASE("what refine says comes back") {
  CellResults results;
  results.refine = CellRefine{};
  results.refine->verdict = "named";
  results.refine->reason = "because";
  results.refine->effects = {{"stribeck", "motor", 0.5, 0.01, 1.25, {"quadratic_drag"}}};
  results.refine->torque = {1, 2, 3, 4, 5, {6, 7}, {8, 9}, true};
  results.refine->next_experiment = "sweep";
  results.refine->error = "none";
  const CellKey key{"k", {}, {}};
  CampaignCell cell;
  cell.name = "low";
  check_same_outputs(cell, results, parse_cell(cell_text(results, key), key));
}

TEST_CASE("numbers that JSON has no words for come back") {
  CellResults results;
  ElasticPreload& preload = results.elastic.emplace().preloads.emplace_back();
  preload.name = "tab\there, \"quoted\" \\";
  preload.unit = "\xff";
  ElasticFit& fit = preload.fits.emplace_back();
  fit.rms_error = -0.0;
  fit.max_abs_error = std::numeric_limits<double>::infinity();
  fit.held_out_rms = -fit.max_abs_error;
  fit.held_out_max = 0.1 + 0.2;
  fit.condition = 1e300;
  fit.covariance = Eigen::MatrixXd::Constant(2, 3, 1e-310);
  const CellKey key{"k", {}, {}};
  const CellResults kept = parse_cell(cell_text(results, key), key);
  const ElasticFit& back = kept.elastic->preloads.front().fits.front();
  CHECK(std::signbit(back.rms_error));
  CHECK(back.max_abs_error == fit.max_abs_error);
  CHECK(back.held_out_rms == fit.held_out_rms);
  CHECK(back.held_out_max == fit.held_out_max);
  CHECK(back.condition == fit.condition);
  CHECK(back.covariance == fit.covariance);
  CHECK(kept.elastic->preloads.front().name == preload.name);
  CHECK(kept.elastic->preloads.front().unit == "\\xff");
}

TEST_CASE("a key tells contents and options apart, not folders, threads or dates") {
  const TempFolder folder;
  fs::copy(CABLEFIT_DATA, folder.path() / "data", fs::copy_options::recursive);
  const Campaign here = shipped();
  Campaign moved = read_campaign(folder.file("data/campaign.json"));
  const auto key = [](const Campaign& campaign, const BatchOptions& options = {}) {
    return key_of(campaign, campaign.cells.front(), options).key;
  };
  const std::string first = key(here);
  CHECK(first.size() == 64);
  CHECK(key(moved) == first);
  BatchOptions options;
  options.samples.threads = 7;
  options.jobs = 3;
  CHECK(key(here, options) == first);
  moved.cells.front().date = "2026-01-01";
  moved.cells.front().name = "other";
  CHECK(key(moved) == first);

  options.samples.cutoff = 50;
  CHECK(key(here, options) != first);
  options = {};
  options.robust_sd = false;
  CHECK(key(here, options) != first);
  Campaign other = here;
  other.estimator = "ols";
  CHECK(key(other) != first);
  other = here;
  other.cells.front().moving.pop_back();
  CHECK(key(other) != first);
  other = here;
  std::swap(other.cells.front().moving[0], other.cells.front().moving[1]);
  CHECK(key(other) != first);
  std::ofstream(folder.file("data/low/rig.json"), std::ios::app) << " ";
  CHECK(key(moved) != first);
}

TEST_CASE("a key hangs on what a rig file names") {
  if (!reads_urdf()) return;
  const TempFolder folder;
  fs::copy(std::string(CABLEFIT_DATA) + "/two_joints/phalanges", folder.path(),
           fs::copy_options::recursive);
  Campaign campaign;
  CampaignCell& cell = campaign.cells.emplace_back();
  cell.rig = folder.file("rig.json");
  cell.moving = {folder.file("moving.csv")};
  const auto key = [&] { return key_of(campaign, cell, {}).key; };
  const std::string first = key();
  std::string urdf = content_of(folder.file("finger.urdf"));
  const auto length = urdf.find("xyz=\"0.1 0 0\"");
  REQUIRE(length != std::string::npos);
  folder.write("finger.urdf", urdf + "<!-- the same arm -->");
  CHECK(key() == first);
  folder.write("finger.urdf", urdf.replace(length, 13, "xyz=\"0.2 0 0\""));
  CHECK(key() != first);
}

TEST_CASE("files of a cell are named as they are today") {
  const std::vector<std::string> before = {"data/low/b.csv", "data/low/rig.json",
                                           "data/low/b.csv.gz"};
  const std::vector<std::string> today = {"/x/b.csv", "/x/rig.json", "/x/b.csv.gz"};
  const auto moved = [&](const std::string& text) {
    return text_here(portable_text(text, before), today);
  };
  CHECK(moved("data/low/b.csv: 3 rows; see data/low/rig.json.") ==
        "/x/b.csv: 3 rows; see /x/rig.json.");
  CHECK(moved("data/low/b.csv.gz") == "/x/b.csv.gz");
  CHECK(moved("data/low/b.csv data/low/b.csv") == "/x/b.csv /x/b.csv");
  for (const char* other :
       {"mydata/low/b.csv", "/data/low/b.csv", "data/low/b.csv2", "no path", ""})
    CHECK(moved(other) == other);
  CHECK(text_here(portable_text("data/low/b.csv", before), before) == "data/low/b.csv");
}

TEST_CASE("a damaged file, or another cell's, is not taken") {
  const TempFolder folder;
  CellResults results;
  results.elastic.emplace().warnings = {"w"};
  const CellKey key{"k", {}, {}}, other{"l", {}, {}};
  const std::string text = cell_text(results, key);
  CHECK(!read_cell_file(folder.file("none.json"), key));
  CHECK(read_cell_file(folder.write("cell.json", text), key).has_value());
  CHECK(!read_cell_file(folder.file("cell.json"), other));
  for (std::size_t n = 0; n + 1 < text.size(); n += 7)
    CHECK(!read_cell_file(folder.write("cell.json", text.substr(0, n)), key));
  CHECK(!read_cell_file(folder.write("cell.json", text + text), key));
  for (std::size_t n = 0; n < text.size();
       n += 5) {  // still JSON, mostly, with another number or letter
    std::string damaged = text;
    damaged[n] = damaged[n] == '1' ? '2' : '1';
    CHECK(!read_cell_file(folder.write("cell.json", damaged), key));
  }
  CHECK_THROWS_AS(parse_cell("[]", key), Error);
}

TEST_CASE("a log that changes after its cell was begun is told") {
  const TempFolder folder;
  fs::copy(CABLEFIT_DATA, folder.path() / "data", fs::copy_options::recursive);
  const Campaign campaign = read_campaign(folder.file("data/campaign.json"));
  const CampaignCell& cell = campaign.cells.front();
  const CellKey key = key_of(campaign, cell, {});
  std::ofstream(cell.blocked.front(), std::ios::app) << "40.0,0,0,0\n";
  CHECK(message_of([&] { fit_cell(campaign, cell, key, {}); }) ==
        cell.blocked.front() +
            ": changed while it was read; run again when no program writes to it");
}

}  // namespace
}  // namespace cablefit
