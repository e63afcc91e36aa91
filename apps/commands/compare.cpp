// cablefit compare: do two results differ by more than their uncertainty, and what changed.
#include "cablefit/campaign/compare/compare.hpp"

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/compare/compare_json.hpp"
#include "cablefit/report/documents/compare_document.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "output/delivery.hpp"
#include "process.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kCompareExample =
    "Example, after 'cablefit dynamic' on two preloads:\n"
    "  cablefit compare cablefit-out/dynamic.json cablefit-out/dynamic.json --preload low high\n"
    "Reads results of elastic, dynamic, identify and batch.\n";

constexpr std::size_t kMostPreloads = 2;

struct CompareCommand {
  CommonOptions common;
  CompareOptions compare;
  std::vector<std::string> results, preloads;
  bool gate_different = false, gate_equal = false;
};

void add_options(CLI::App& app, CompareCommand& command) {
  app.add_option("RESULT", command.results, "two result files: A, then B")->type_name("");
  add_number(
      app, "--margin", "PERCENT", {0},
      [&command](double percent) { command.compare.margin = percent / 100; },
      "differences below it do not matter [5]");
  add_number(
      app, "--significance", "P", {1e-9, 0.5},
      [&command](double p) { command.compare.significance = p; },
      "probability of a false 'different' among all parameters, and of each false 'equal' [0.05]");
  app.add_option("--preload", command.preloads,
                 "which preload (of a campaign: which cell); two names: of A, of B [all]")
      ->type_name("NAME");
  app.add_option("--model", command.compare.model,
                 "which model [stage 1's choice, else the richest that both have]")
      ->type_name("NAME");
  app.add_flag("--gate-different", command.gate_different,
               "exit 1 when a parameter is different and the difference may exceed the margin");
  app.add_flag("--gate-equal", command.gate_equal,
               "exit 1 unless every parameter of both is shown to be within the margin");
}

void take_preloads(CompareCommand& command) {
  if (command.preloads.empty()) return;
  if (command.preloads.size() > kMostPreloads)
    throw usage_error("more than two preloads", "name one for both results, or one for each");
  command.compare.first_preload = command.preloads.front();
  command.compare.second_preload = command.preloads.back();
}

std::vector<InputFile> input_files(const std::vector<std::string>& paths) {
  std::vector<InputFile> inputs;
  for (const std::string& path : paths) inputs.push_back({path, sha256_of_file(path), 0});
  return inputs;
}

std::vector<std::string> failed_gates(const CompareCommand& command, const CompareResult& result) {
  std::vector<std::string> failed;
  for (const ComparedParameter& p : result.parameters) {
    const std::string where = p.preload.empty() ? "" : p.preload + ": ";
    if (command.gate_different && p.sameness == Sameness::different && !p.is_within_margin)
      failed.push_back(fmt::format("FAILED: {}{}", where, change_text(p)));
    else if (command.gate_equal && !p.is_within_margin)
      failed.push_back(
          fmt::format("FAILED: {}{} is not shown to be within the margin", where, p.name));
  }
  // What can no longer be determined, or is not there any more, is not shown to be equal.
  if (command.gate_equal)
    for (const Uncompared& one : result.not_compared)
      failed.push_back(fmt::format("FAILED: {}{}{} is not compared: {}", one.preload,
                                   one.preload.empty() ? "" : ": ", one.name, one.reason));
  return failed;
}

}  // namespace

int run_compare(const Arguments& arguments) {
  CLI::App app("Find the parameters of two results that differ by more than their uncertainty.",
               "compare");
  CompareCommand command;
  add_options(app, command);
  add_output_options(app, command.common);
  app.footer(kCompareExample);
  if (!parse(app, arguments)) return 0;
  if (command.results.size() != 2)
    throw usage_error(fmt::format("compare takes two results, not {}", command.results.size()),
                      "cablefit compare A.json B.json");
  take_preloads(command);
  command.common.more_inputs = command.results;

  Problems problems;
  std::vector<RecordedResult> results;
  for (const std::string& path : command.results)
    problems.collect([&] { results.push_back(read_recorded_result(path)); });
  problems.throw_if_any();
  const CompareResult result =
      compare(std::move(results[0]), std::move(results[1]), command.compare);
  const std::vector<std::string> failed = failed_gates(command, result);
  deliver(command.common, compare_document(result),
          {{"compare.json", compare_json(result, input_files(command.results), failed)}});
  for (const std::string& line : failed) complain(printable(line) + "\n");
  return failed.empty() ? 0 : kGateFailed;
}

}  // namespace cablefit::apps
