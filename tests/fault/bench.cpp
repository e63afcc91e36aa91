#include "tests/fault/bench.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "tests/fault/program.hpp"
#include "tests/support/low_model.hpp"

namespace cablefit::test {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string first_lines(const std::string& text, int n_lines) {
  std::size_t end = 0;
  for (int k = 0; k < n_lines && end != std::string::npos; ++k) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

FaultBench::FaultBench() {
  restore_log();
  folder_.write("moving.csv",
                first_lines(content_of(CABLEFIT_DATA "/low/moving_load30.csv"), 4000));
  fs::copy_file(CABLEFIT_DATA "/low/rig.json", path("rig.json"));
  folder_.write("model.json", kLowModel);
}

void FaultBench::restore_log() const {
  static const std::string log = first_lines(content_of(CABLEFIT_DATA "/low/blocked.csv"), 10000);
  folder_.write("log.csv", log);
}

Ended FaultBench::run(const Arguments& arguments, const Environment& environment, Blow blow) const {
  return run_program(folder_.path().string(), arguments, environment, blow);
}

FaultBench::Calls FaultBench::count(const Arguments& arguments, const Environment& more) const {
  Environment environment = more;
  environment["FAULT_COUNT"] = path("count");
  const Ended ended = run(arguments, environment);
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  Calls calls;
  std::istringstream(content_of(path("count"))) >> calls.writes >> calls.reads >> calls.opens;
  return calls;
}

std::map<std::string, std::string> FaultBench::files() const { return files_below(path("out")); }

std::map<std::string, std::string> files_below(const std::filesystem::path& out) {
  std::map<std::string, std::string> files;
  if (!fs::exists(out)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    if (entry.is_directory()) continue;
    files[fs::relative(entry.path(), out).string()] = content_of(entry.path().string());
  }
  return files;
}

void FaultBench::reset(const Writer& writer, bool with_old) const {
  fs::remove_all(path("out"));
  if (!with_old) return;
  fs::create_directory(path("out"));
  for (const std::string& target : writer.targets) folder_.write("out/" + target, kOldContent);
}

std::vector<Writer> writers() {
  return {
      {"elastic",
       {"elastic", "log.csv", "--out", "out", "--json", "out/a.json", "--report", "out/a.md"},
       {"elastic.json", "a.json", "a.md"}},
      {"dynamic",
       {"dynamic", "log.csv", "moving.csv", "--model", "linear", "--out", "out", "--report",
        "out/a.csv", "--elastic", "stage1.json"},
       {"dynamic.json", "a.csv"}},
      {"simulate",
       {"simulate", "model.json", "moving.csv", "--out", "out", "--trajectories", "out/rows.csv"},
       {"simulate.json", "rows.csv"}},
      {"check", {"check", "log.csv", "--json", "out/check.json"}, {"check.json"}},
      {"identify",
       {"identify", "log.csv", "moving.csv", "--l-o", "known", "--recursive", "--out", "out"},
       {"identify.json", "identify_trace.csv", "model_low.json"}}};
}

void check_whole(const FaultBench& bench, const Writer& writer, bool with_old,
                 const std::map<std::string, std::string>& whole) {
  const std::map<std::string, std::string> files = bench.files();
  for (const auto& [name, content] : files) {
    INFO(name);
    const auto expected = whole.find(name);
    REQUIRE(expected != whole.end());
    REQUIRE((content == expected->second || (with_old && content == kOldContent)));
  }
  if (with_old) REQUIRE(files.size() == writer.targets.size());
}

}  // namespace cablefit::test
