// A result on its way out: screen, result files and reports.
#pragma once

#include <string>
#include <vector>

#include "cablefit/report/document.hpp"
#include "commands/common_options.hpp"

namespace cablefit::apps {

struct ResultFile {
  std::string name;  ///< below --out: "elastic.json"; empty: only on request by --json
  std::string content;
  bool has_own_path = false;  ///< `name` is the path, not below --out
};

/// A result never replaces what it was made from, nor another result of the same run: throws
/// Error(usage). deliver() sees to it too, but after the work is done.
void refuse_collisions(const CommonOptions& options, const std::vector<ResultFile>& results);

/// Prints the document (warnings to stderr under --quiet or --json -), then writes the result files
/// below --out, --json (the first result) and every --report. Throws Error(output) listing all that
/// could not be written.
void deliver(const CommonOptions& options, const Document& document,
             const std::vector<ResultFile>& results);

}  // namespace cablefit::apps
