// The EMPS log in other clothes: JSON channels, gzip, zstd, other units. The parameters must be the
// same to 1e-9.
#include <cstdlib>

#include "cablefit/base/files/output_file.hpp"
#include "tests/reference/shared_data.hpp"
#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

Rig linear_rig() {
  Rig rig = default_rig();
  rig.axes = JointAxes({Axes::linear});
  return rig;
}

std::vector<Estimate> fit(const std::string& path) {
  const std::vector<LogSurvey> logs = {survey_file(path, linear_rig())};
  return fit_dynamic(logs, {}, emps_options()).preloads.at(0).fits.at(0).parameters;
}

void check_same(const std::vector<Estimate>& a, const std::vector<Estimate>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    INFO(a[k].name);
    CHECK(a[k].name == b[k].name);
    CHECK(a[k].unit == b[k].unit);
    CHECK_THAT(b[k].value, Catch::WithinRel(a[k].value, 1e-9));
    // The HAC sd goes through a data-driven bandwidth, continuous in the data; the method's floor
    // through a simulated copy whose encoder rounds, here and there the other way.
    CHECK_THAT(b[k].sd, Catch::WithinRel(a[k].sd, 1e-4));
    CHECK_THAT(b[k].sd_white, Catch::WithinRel(a[k].sd_white, 1e-9));
  }
}

/// The columns t, theta, tau, as text, header left out.
std::vector<std::vector<std::string>> cells(const std::string& path) {
  std::vector<std::vector<std::string>> columns(3);
  const std::string text = content_of(path);
  for (std::size_t at = text.find('\n') + 1; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t comma = text.find(',', at);
      columns[c].push_back(text.substr(at, comma - at));
      at = comma + 1;
    }
    at = end == std::string::npos ? text.size() : end + 1;
  }
  return columns;
}

/// A power of ten less: "89.23" in N is "89.23e-3" in kN, without rounding.
std::string csv(const std::vector<std::vector<std::string>>& c, const std::string& header,
                const std::string& theta_power, const std::string& tau_power) {
  std::string text = header + '\n';
  for (std::size_t i = 0; i < c[0].size(); ++i) {
    const auto scaled = [](const std::string& cell, const std::string& power) {
      if (power.empty()) return cell;
      const std::size_t e = cell.find_first_of("eE");
      const int exponent =
          (e == std::string::npos ? 0 : std::stoi(cell.substr(e + 1))) + std::stoi(power);
      return cell.substr(0, e) + 'e' + std::to_string(exponent);
    };
    text += c[0][i] + ',' + scaled(c[1][i], theta_power) + ',' + scaled(c[2][i], tau_power) + '\n';
  }
  return text;
}

TEST_CASE("EMPS is the same log in every format and unit", "[reference]") {
  const std::string path = shared_file("emps/emps_ident.csv");
  if (path.empty()) return;
  const TempFolder folder;
  const std::vector<Estimate> plain = fit(path);
  CHECK(estimate(plain, "J").unit == "kg");
  CHECK(estimate(plain, "f_v").unit == "N s/m");
  CHECK(estimate(plain, "f_s").unit == "N");
  CHECK(estimate(plain, "offset").unit == "N");

  const auto columns = cells(path);
  REQUIRE(columns[0].size() == columns[2].size());
  {
    INFO("mm and kN");
    check_same(plain, fit(folder.write("units.csv",
                                       csv(columns, "t [s],theta [mm],tau (kN)", "3", "-3"))));
  }
  {
    INFO("units spelt out");
    check_same(plain, fit(folder.write("m.csv", csv(columns, "t,theta [m],tau [N]", "", ""))));
  }
  {
    INFO("JSON channels");
    const auto list = [](const std::vector<std::string>& cells) {
      std::string text;
      for (const std::string& cell : cells) text += (text.empty() ? "" : ",") + cell;
      return '[' + text + ']';
    };
    check_same(plain,
               fit(folder.write("emps.json", "{\"sample_rate\": 1000, \"channels\": {\"theta\": " +
                                                 list(columns[1]) +
                                                 ", \"tau\": " + list(columns[2]) + "}}")));
  }
  for (const char* command : {"gzip -c", "zstd -qc"}) {
    INFO(command);
    const std::string packed = folder.file(command[0] == 'g' ? "emps.gz" : "emps.zst");
    if (std::system((std::string(command) + ' ' + path + " > " + packed).c_str()) != 0) {
      WARN("skipped: " << command << " is not there");
      continue;
    }
    check_same(plain, fit(packed));
  }
}

TEST_CASE("an angle on a linear axis is refused at its header cell", "[reference]") {
  const TempFolder folder;
  const std::string path = folder.write("a.csv", "t,theta [deg],tau\n0,1,2\n");
  CHECK_THROWS_WITH(plan_log(path, linear_rig()),
                    path +
                        ":1:3: unit 'deg' of column 'theta' is not a position's; correct the "
                        "unit in the header or in the rig file");
}

}  // namespace
