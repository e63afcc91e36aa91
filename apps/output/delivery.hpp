// A result on its way out: screen, result files and reports.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/report/parts/document.hpp"
#include "cablefit/samples/survey/survey.hpp"
#include "options/common_options.hpp"

namespace cablefit::apps {

struct ResultFile {
  std::string name;  ///< below --out: "elastic.json"; empty: only on request by --json
  std::string content;
  bool has_own_path = false;  ///< `name` is the path, not below --out
};

/// A result never replaces what it was made from, nor another result of the same run: throws
/// Error(usage). deliver() sees to it too, but after the work is done.
void refuse_collisions(const CommonOptions& options, const std::vector<ResultFile>& results);

/// What is odd about logs, to stderr.
void complain_of(std::span<const LogSurvey> logs);

/// The result of `fit`. Where it fails, warnings about its logs are printed first: they may give
/// the cause.
template <typename Fit>
auto or_why(std::span<const LogSurvey> logs, const Fit& fit) {
  try {
    return fit();
  } catch (const Error&) {
    complain_of(logs);
    throw;
  }
}

/// Prints the document (warnings to stderr under --quiet or --json -), then writes the result files
/// below --out, --json (the first result) and every --report: all of them or none. Throws
/// Error(output) listing all that could not be written.
void deliver(const CommonOptions& options, const Document& document,
             const std::vector<ResultFile>& results);

}  // namespace cablefit::apps
