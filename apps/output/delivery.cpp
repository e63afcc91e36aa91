#include "output/delivery.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/base/files/output_file.hpp"
#include "cablefit/base/problems.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/report/parts/escape.hpp"
#include "cablefit/report/writers/screen.hpp"
#include "cablefit/report/writers/wrap.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "origin.hpp"
#include "output/colour.hpp"
#include "process.hpp"

namespace cablefit::apps {
namespace {

std::string quoted_path(const std::string& path) { return in_quotes(path); }

bool is_stdout(const std::string& path) { return path == "-"; }

std::string path_of(const CommonOptions& options, const ResultFile& result) {
  if (result.has_own_path) return result.name;
  return (std::filesystem::path(options.out) / result.name).string();
}

/// Every file this run writes.
std::vector<std::string> targets(const CommonOptions& options,
                                 const std::vector<ResultFile>& results) {
  std::vector<std::string> paths = options.reports;
  for (const ResultFile& result : results)
    if (!result.name.empty()) paths.push_back(path_of(options, result));
  if (!options.json.empty() && !is_stdout(options.json)) paths.push_back(options.json);
  return paths;
}

bool prints_document(const CommonOptions& options) {
  return !options.quiet && !is_stdout(options.json);
}

void print(const CommonOptions& options, const Document& document) {
  if (prints_document(options)) {
    const std::string text = write_text(options.verbose ? document : on_screen(document));
    write_whole("-", shows_colour() ? coloured(text) : text);
    return;
  }
  for (const std::string& warning : document.warnings) {
    complain(fmt::format("warning: {}\n", printable(warning)));
  }
}

/// Where the files are, once they are there, and how to see more.
void print_closing_lines(const CommonOptions& options, const Document& document,
                         const std::vector<ResultFile>& results) {
  if (!prints_document(options)) return;
  std::string text;
  constexpr std::size_t kMostNamed = 4;
  std::vector<std::string> paths = targets(options, results);
  const auto is_below_out = [&options](const ResultFile& result) {
    return !result.name.empty() && !result.has_own_path;
  };
  const auto n_below = std::count_if(results.begin(), results.end(), is_below_out);
  if (n_below > static_cast<std::ptrdiff_t>(kMostNamed)) {  // a folder says it shorter
    for (const ResultFile& result : results)
      if (is_below_out(result)) std::erase(paths, path_of(options, result));
    paths.push_back(fmt::format("{} files in {}", n_below, options.out));
  }
  if (!paths.empty()) text += fmt::format("Written: {}. ", fmt::join(paths, ", "));
  const bool has_more = write_text(on_screen(document)) != write_text(document);
  if (has_more && !options.verbose)
    text += fmt::format("All tables and choices: --verbose{}",
                        options.reports.empty() ? "; plots: --report FILE.html" : "");
  if (!text.empty()) write_whole("-", "\n" + wrapped("", printable(text), 0));
}

/// All files or none: a result without its report would look like a run that went well.
void write_files(const CommonOptions& options, const Document& document,
                 const std::vector<ResultFile>& results) {
  Document reported = document;
  reported.origin = origin();
  WholeFiles files;
  Problems problems;
  const auto add = [&](const std::string& path, std::string content) {
    problems.collect([&] { files.add(path, std::move(content)); });
  };
  for (const ResultFile& result : results)
    if (!result.name.empty()) add(path_of(options, result), result.content);
  if (!options.json.empty()) add(options.json, results.front().content);
  for (const std::string& path : options.reports)
    add(path, report_writer_for(path).write(reported));
  problems.throw_if_any();
  files.finish();
}

/// Every file this run reads, the rig files that it finds beside its logs among them.
std::vector<std::string> inputs_of(const CommonOptions& options) {
  std::vector<std::string> inputs = options.logs;
  inputs.insert(inputs.end(), options.more_inputs.begin(), options.more_inputs.end());
  const std::size_t n_named = inputs.size();
  for (std::size_t k = 0; k < n_named; ++k)
    inputs.push_back((std::filesystem::path(inputs[k]).parent_path() / "rig.json").string());
  if (!options.rig.empty()) inputs.push_back(options.rig);
  return inputs;
}

}  // namespace

void complain_of(std::span<const LogSurvey> logs) {
  for (const LogSurvey& log : logs)
    for (const std::string& warning : log.warnings)
      complain(fmt::format("warning: {}\n", printable(warning)));
}

void refuse_collisions(const CommonOptions& options, const std::vector<ResultFile>& results) {
  const std::vector<std::string> paths = targets(options, results);
  const auto same = [](const std::string& a, const std::string& b) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(a, ignored) ==
           std::filesystem::weakly_canonical(b, ignored);
  };
  const std::vector<std::string> inputs = inputs_of(options);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    for (const std::string& input : inputs)
      if (same(paths[k], input))
        throw usage_error(
            fmt::format("{} would be overwritten by the result made from it", quoted_path(input)),
            "choose another --out, --json or --report");
    for (std::size_t j = 0; j < k; ++j)
      if (same(paths[k], paths[j]))
        throw usage_error(fmt::format("{} would be written twice", quoted_path(paths[k])),
                          "give each result a file of its own");
  }
}

void deliver(const CommonOptions& options, const Document& document,
             const std::vector<ResultFile>& results) {
  refuse_collisions(options, results);
  Problems problems;
  problems.collect([&] { print(options, document); });
  problems.collect([&] { write_files(options, document, results); });
  problems.throw_if_any();
  print_closing_lines(options, document, results);
}

}  // namespace cablefit::apps
