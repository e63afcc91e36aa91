#include "commands/delivery.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "cablefit/base/output_file.hpp"
#include "cablefit/report/escape.hpp"
#include "cablefit/report/writers.hpp"
#include "commands/problems.hpp"

namespace cablefit::apps {
namespace {

bool is_stdout(const std::string& path) { return path == "-"; }

void print(const CommonOptions& options, const Document& document) {
  if (!options.quiet && !is_stdout(options.json)) {
    write_whole("-", write_text(options.verbose ? document : without_details(document)));
    return;
  }
  for (const std::string& warning : document.warnings) {
    fmt::print(stderr, "warning: {}\n", printable(warning));
  }
}

}  // namespace

void deliver(const CommonOptions& options, const Document& document,
             const std::vector<ResultFile>& results) {
  Problems problems;
  const auto write = [&problems](const std::string& path, const std::string& content) {
    problems.collect([&] { write_whole(path, content); });
  };
  problems.collect([&] { print(options, document); });
  for (const ResultFile& result : results) {
    if (!result.name.empty()) {
      write((std::filesystem::path(options.out) / result.name).string(), result.content);
    }
  }
  if (!options.json.empty()) write(options.json, results.front().content);
  for (const std::string& path : options.reports) {
    write(path, report_writer_for(path).write(document));
  }
  problems.throw_if_any();
}

}  // namespace cablefit::apps
