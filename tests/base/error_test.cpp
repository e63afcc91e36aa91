#include "cablefit/base/error.hpp"

#include <catch2/catch.hpp>

namespace cablefit {

TEST_CASE("a place prints what is known of it") {
  CHECK(to_string({"log.csv", 7, 13}) == "log.csv:7:13");
  CHECK(to_string({"log.csv", 7, 0}) == "log.csv:7");
  CHECK(to_string({"log.csv", 0, 0}) == "log.csv");
  CHECK(to_string({}).empty());
}

TEST_CASE("errors carry place, hint and exit code") {
  const Error bad_input = input_error({"rig.json", 2, 5}, "missing key 'name'", "add it");
  CHECK(bad_input.what() == std::string("rig.json:2:5: missing key 'name'; add it"));
  CHECK(bad_input.kind() == ErrorKind::input);
  CHECK(input_error({}, "unknown unit 'x'", "").what() == std::string("unknown unit 'x'"));

  const Error bad_usage = usage_error("unknown option --rg", "did you mean '--rig'?");
  CHECK(bad_usage.what() == std::string("unknown option --rg; did you mean '--rig'?"));
  CHECK(static_cast<int>(bad_usage.kind()) == 2);
}

TEST_CASE("no message steers the terminal, and one message is one line") {
  const std::string name = "low\x1b[2J\n";
  CHECK(input_error({name, 3, 0}, name, name).what() ==
        std::string("low\\x1b[2J\\x0a:3: low\\x1b[2J\\x0a; low\\x1b[2J\\x0a"));
  CHECK(usage_error(name, "").what() == std::string("low\\x1b[2J\\x0a"));
  // Several messages stand below each other.
  CHECK(Error(ErrorKind::output, "a\x07\nb").what() == std::string("a\\x07\nb"));
}

}  // namespace cablefit
