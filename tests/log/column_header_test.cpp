#include "cablefit/log/column_header.hpp"

#include <catch2/catch.hpp>

#include "tests/support/message.hpp"

namespace cablefit {

TEST_CASE("a header cell is a name and perhaps a unit") {
  struct Case {
    const char* text;
    const char* name;
    const char* unit;
  };
  const Case c = GENERATE(values<Case>({
      {"tau", "tau", ""},
      {" theta [deg] ", "theta", "deg"},
      {"theta(deg)", "theta", "deg"},
      {"tau (mN m)", "tau", "mN m"},
      {"f_v [Nm/(rad/s)]", "f_v", "Nm/(rad/s)"},
      {"f_v (Nm/(rad/s))", "f_v", "Nm/(rad/s)"},
      {"motor 1 position [deg]", "motor 1 position", "deg"},
      {"q[1]", "q[1]", ""},
      {"q[1] [deg]", "q[1]", "deg"},
      {"efficiency [1]", "efficiency", "1"},
      {"efficiency [-]", "efficiency", "-"},
      {"[deg]", "[deg]", ""},
      {"q]", "q]", ""},
      {"", "", ""},
  }));
  INFO(c.text);
  const ColumnHeader column = to_column_header(c.text, {});
  CHECK(column.name == c.name);
  CHECK(column.unit == c.unit);
}

TEST_CASE("two columns of one name are refused, two without a name are not") {
  const auto check = [](std::vector<ColumnHeader> columns) {
    return test::message_of([&] { check_names(columns, {"log.csv", 1}); });
  };
  CHECK(check({{"q", "rad", {}}, {"", "", {}}, {"", "", {}}}) == "no error");
  CHECK(check({{"q", "rad", {}}, {"q", "deg", {"log.csv", 1, 9}}}) ==
        "log.csv:1:9: column 'q' appears twice; rename one of them");
  CHECK(check({{"", "", {}}}) == "log.csv:1: no column names; name the columns, as t,q,theta,tau");
}

}  // namespace cablefit
