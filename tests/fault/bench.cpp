#include "tests/fault/bench.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

#include "tests/support/low_model.hpp"

namespace cablefit::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCampaign = R"({"schema": "cablefit/campaign/1", "name": "bench",
  "cells": [{"rig": "rig.json", "preload": "low", "blocked": ["log.csv"],
             "moving": ["moving.csv"]}]})";

std::string first_lines(const std::string& text, int n_lines) {
  std::size_t end = 0;
  for (int k = 0; k < n_lines && end != std::string::npos; ++k) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

[[noreturn]] void become_program(const std::string& folder, const Arguments& arguments,
                                 const Environment& environment) {
  if (::chdir(folder.c_str()) != 0) ::_exit(99);
  const int err = ::open("err", O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int out = ::open("/dev/null", O_WRONLY);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  ::setenv("LD_PRELOAD", CABLEFIT_FAILING_CALLS, 1);
  ::setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1);
  std::vector<char*> argv{const_cast<char*>(CABLEFIT_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(CABLEFIT_PROGRAM, argv.data());
  ::_exit(99);
}

Ended end_of(pid_t process) {
  int status = 0;
  ::waitpid(process, &status, 0);
  Ended ended;
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  return ended;
}

}  // namespace

FaultBench::FaultBench() {
  restore_log();
  folder_.write("moving.csv",
                first_lines(content_of(CABLEFIT_DATA "/low/moving_load30.csv"), 4000));
  fs::copy_file(CABLEFIT_DATA "/low/rig.json", path("rig.json"));
  folder_.write("model.json", kLowModel);
  folder_.write("campaign.json", kCampaign);
}

void FaultBench::restore_log() const {
  static const std::string log = first_lines(content_of(CABLEFIT_DATA "/low/blocked.csv"), 10000);
  folder_.write("log.csv", log);
}

Ended FaultBench::run(const Arguments& arguments, const Environment& environment, Blow blow) const {
  // A signal must not find the child before it is the program, with the handlers of the test in it.
  sigset_t all, usual;
  sigfillset(&all);
  ::sigprocmask(SIG_BLOCK, &all, &usual);
  const pid_t process = ::fork();
  if (process == 0) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  }
  ::sigprocmask(SIG_SETMASK, &usual, nullptr);
  if (process == 0) become_program(folder_.path().string(), arguments, environment);
  if (blow.signal != 0) {
    std::this_thread::sleep_for(std::chrono::microseconds(blow.after_us));
    ::kill(process, blow.signal);
  }
  Ended ended = end_of(process);
  ended.err = content_of(path("err"));
  return ended;
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

std::map<std::string, std::string> FaultBench::files() const {
  std::map<std::string, std::string> files;
  const fs::path out = path("out");
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
      {"batch",
       {"batch", "campaign.json", "--out", "out", "--report", "out/a.txt"},
       {"batch.json", "elastic.json", "dynamic.json", "a.txt"}},
      {"check", {"check", "log.csv", "--json", "out/check.json"}, {"check.json"}},
      {"identify",
       {"identify", "log.csv", "moving.csv", "--l_o", "known", "--recursive", "--out", "out"},
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
