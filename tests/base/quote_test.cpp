#include "cablefit/base/quote.hpp"

#include <catch2/catch.hpp>

namespace cablefit {

TEST_CASE("quoted text is safe to print") {
  CHECK(quoted("tau") == "'tau'");
  CHECK(quoted("") == "''");
  CHECK(quoted("a\tb\x1b[31m") == "'a\\x09b\\x1b[31m'");
  CHECK(quoted("θ [°]") == "'θ [°]'");
  CHECK(quoted("\xb0") == "'\\xb0'");
  CHECK(quoted("\xc2\x9b") == "'\\xc2\\x9b'");
  CHECK(quoted("\xce") == "'\\xce'");
}

TEST_CASE("quoted text is cut at 60 bytes, never inside a character") {
  CHECK(quoted(std::string(60, 'x')) == "'" + std::string(60, 'x') + "'");
  CHECK(quoted(std::string(61, 'x')) == "'" + std::string(60, 'x') + "...'");
  CHECK(quoted(std::string(59, 'x') + "θ") == "'" + std::string(59, 'x') + "...'");
}

}  // namespace cablefit
