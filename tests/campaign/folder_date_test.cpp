#include "cablefit/campaign/plan/folder_date.hpp"

#include <catch2/catch.hpp>

namespace cablefit {
namespace {

TEST_CASE("folders called by a date or a week") {
  CHECK(date_of_folder("2026-11-09") == "2026-11-09");
  CHECK(date_of_folder("2026_11_09") == "2026-11-09");
  CHECK(date_of_folder("20261109") == "2026-11-09");
  CHECK(date_of_folder("09.11.2026") == "2026-11-09");
  CHECK(date_of_folder("2026-w46") == "2026-11-09");
  CHECK(date_of_folder("2026W01") == "2025-12-29");  // ISO 8601: the week of 4 January
  CHECK(date_of_folder("2020-w53") == "2020-12-28");
}

TEST_CASE("folders called by anything else") {
  for (const char* name : {"low", "high", "", "2026", "20261332", "2026-w60", "32.01.2026",
                           "12345678", "preload 2026-11-09"})
    CHECK_FALSE(date_of_folder(name).has_value());
}

}  // namespace
}  // namespace cablefit
