#include "cablefit/report/writers/junit.hpp"

#include <fmt/format.h>

#include <string_view>

#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

/// U+FFFE and U+FFFF, which XML does not have.
bool is_no_character(std::string_view text) {
  return text.starts_with("\xEF\xBF\xBE") || text.starts_with("\xEF\xBF\xBF");
}

/// Within an attribute in double quotes. XML 1.0 has no way to write most control bytes: they are
/// made printable.
std::string attribute(const std::string& text) {
  const std::string shown = printable(text);
  std::string safe;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    switch (shown[i]) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        if (is_no_character(std::string_view(shown).substr(i))) {
          safe += '?';
          i += 2;
        } else {
          safe += shown[i];
        }
    }
  }
  return safe;
}

/// `kind`: "failure" or "error"; an empty message: passed.
std::string testcase(const std::string& cell, const std::string& name, const char* kind,
                     const std::string& message) {
  const std::string start =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\"", attribute(cell), attribute(name));
  if (message.empty()) return start + "/>\n";
  return fmt::format("{}>\n      <{} message=\"{}\"/>\n    </testcase>\n", start, kind,
                     attribute(message));
}

struct Suite {
  std::string cases;
  std::size_t n_tests = 0, n_failures = 0, n_errors = 0;
};

Suite suite_of(const BatchResult& result, const BatchCell& cell) {
  Suite suite;
  suite.cases = testcase(cell.name, "fitted", "error", cell.error);
  suite.n_tests = 1;
  suite.n_errors = cell.error.empty() ? 0 : 1;
  if (!cell.error.empty()) return suite;  // its one gate says the same
  for (const Gate& gate : result.gates) {
    if (gate.cell != cell.name) continue;
    suite.cases += testcase(cell.name, gate.name, "failure", gate.passed ? "" : gate.text);
    ++suite.n_tests;
    suite.n_failures += gate.passed ? 0 : 1;
  }
  return suite;
}

std::string counts(const Suite& suite) {
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", suite.n_tests, suite.n_failures,
                     suite.n_errors);
}

}  // namespace

std::string junit_xml(const BatchResult& result) {
  Suite all;
  for (const BatchCell& cell : result.cells) {
    const Suite suite = suite_of(result, cell);
    all.cases += fmt::format("  <testsuite name=\"{}\" {}>\n{}  </testsuite>\n",
                             attribute(cell.name), counts(suite), suite.cases);
    all.n_tests += suite.n_tests;
    all.n_failures += suite.n_failures;
    all.n_errors += suite.n_errors;
  }
  const std::string name = result.campaign_name.empty() ? "campaign" : result.campaign_name;
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" {}>\n{}</testsuites>\n",
      attribute(name), counts(all), all.cases);
}

}  // namespace cablefit
