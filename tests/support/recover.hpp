// Simulate, fit, compare: logs of the truth simulator on their way through both stages.
#pragma once

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/truth/rig.hpp"

namespace cablefit::test {

inline LogSurvey survey_file(const std::string& path, const Rig& rig,
                             const std::string& preload = "") {
  return survey_log(plan_log(path, rig), preload);
}

/// A shipped log with the rig.json beside it.
inline LogSurvey shipped(const std::string& name) {
  const std::string path = std::string(CABLEFIT_DATA) + '/' + name;
  const Rig rig = rig_for_log(path, "");
  return survey_file(path, rig, rig.preload);
}

/// Logs written to a folder of their own and surveyed, all with one rig.
class Bench {
 public:
  Rig rig = default_rig();

  const LogSurvey& add(const truth::Log& log) {
    const std::string path = folder_->file(fmt::format("log{}.csv", logs_.size()));
    truth::write_csv(path, log);
    return add_file(path);
  }
  const LogSurvey& add_text(const std::string& text) {
    return add_file(folder_->write(fmt::format("log{}.csv", logs_.size()), text));
  }
  const LogSurvey& add_file(const std::string& path) {
    logs_.push_back(survey_file(path, rig));
    return logs_.back();
  }
  std::span<const LogSurvey> logs() const { return logs_; }
  const TempFolder& folder() const { return *folder_; }

 private:
  std::unique_ptr<TempFolder> folder_ = std::make_unique<TempFolder>();
  std::vector<LogSurvey> logs_;
};

/// With a rig file of that text.
inline Bench bench_of(const std::string& rig) {
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig));
  return bench;
}

/// The estimate of that name; the test stops when there is none.
inline const Estimate& estimate(const std::vector<Estimate>& estimates, const std::string& name) {
  const Estimate* found = find_estimate(estimates, name);
  INFO("parameter " << name);
  REQUIRE(found != nullptr);
  return *found;
}

using NamedValues = std::vector<std::pair<std::string, double>>;

inline NamedValues dynamic_truth(const truth::Rig& rig) {
  return {{"J_link", rig.J_link}, {"J_motor", rig.J_motor}, {"f_v", rig.f_v},      {"f_s", rig.f_s},
          {"f_vm", rig.f_vm},     {"f_sm", rig.f_sm},       {"offset", rig.offset}};
}

/// K1_0, K1_1, ..., K2_0, ...: the paper's names.
inline NamedValues elastic_truth(const truth::Rig& rig) {
  NamedValues values;
  const truth::Cable* cables[] = {&rig.cable_1, &rig.cable_2};
  for (int c = 0; c < 2; ++c)
    for (std::size_t k = 0; k < cables[c]->stiffness.size(); ++k)
      values.emplace_back(fmt::format("K{}_{}", c + 1, k), cables[c]->stiffness[k]);
  return values;
}

/// Every parameter within `limit` of its own sd of the truth; prints value, sd and distance.
inline void check_recovered(const std::vector<Estimate>& estimates, const NamedValues& truth,
                            double limit) {
  for (const auto& [name, value] : truth) {
    const Estimate& e = estimate(estimates, name);
    INFO(name << ": " << e.not_identifiable);
    REQUIRE(e.not_identifiable.empty());
    REQUIRE(e.sd > 0);
    const double distance = (e.value - value) / e.sd;
    std::printf("    %-8s true %12.6g  found %12.6g  sd %9.3g  off by %+6.2f sd %+8.3f %%\n",
                name.c_str(), value, e.value, e.sd, distance,
                value != 0 ? 100 * (e.value - value) / value : 0.0);
    INFO(name << " found " << e.value << " +- " << e.sd << ", true " << value);
    CHECK(std::abs(distance) < limit);
  }
}

inline bool warns(const std::vector<std::string>& warnings, const std::string& words) {
  for (const std::string& warning : warnings)
    if (warning.find(words) != std::string::npos) return true;
  return false;
}

inline void print_all(const char* title, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::printf("    %s: %s\n", title, line.c_str());
}

}  // namespace cablefit::test
