// The campaign file: what it may say, and how it complains.
#include "cablefit/campaign/campaign.hpp"

#include <catch2/catch.hpp>

#include "cablefit/base/error.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

using test::message_of;
using test::TempFolder;

struct BadCampaign {
  std::string text;
  std::string message;  // after the path
};

TEST_CASE("the shipped campaign is read, with paths relative to it") {
  const Campaign campaign = read_campaign(CABLEFIT_DATA "/campaign.json");
  REQUIRE(campaign.cells.size() == 2);
  CHECK(campaign.cells[0].preload == "low");
  CHECK(campaign.cells[1].rig == CABLEFIT_DATA "/high/rig.json");
  CHECK(campaign.cells[0].moving.size() == 2);
  CHECK(campaign.models == std::vector<std::string>{"linear", "poly"});
  CHECK(campaign.limits.rsd_percent == 25);
}

TEST_CASE("patterns are expanded in order") {
  const TempFolder folder;
  for (const char* name : {"b2.csv", "b1.csv", "c.csv"}) folder.write(name, "t,q\n");
  const std::string path = folder.write("campaign.json",
                                        R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["b*.csv"]}]})");
  CHECK(read_campaign(path).cells[0].blocked ==
        std::vector<std::string>{folder.file("b1.csv"), folder.file("b2.csv")});
}

TEST_CASE("a bad campaign is refused with its place") {
  const TempFolder folder;
  folder.write("b.csv", "t,q\n");
  const std::vector<BadCampaign> cases = {
      {R"({"schema": "cablefit/rig/1", "cells": []})",
       ":1:12: 'schema' is 'cablefit/rig/1', not a campaign; a campaign file says "
       "\"cablefit/campaign/1\""},
      {R"({"schema": "cablefit/campaign/1", "cells": []})",
       ":1:44: 'cells' is empty; a cell is {\"rig\", \"preload\", \"blocked\", \"moving\"}"},
      {R"({"schema": "cablefit/campaign/1", "cell": []})",
       ":1:43: unknown key 'cell'; did you mean 'cells'?"},
      {R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["none*.csv"]}]})",
       ":2:41: no file matches 'none*.csv'; paths are relative to the campaign "
       "file"},
      {R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "moving": ["b.csv"]}]})",
       ":2:12: the cell has no blocked logs; stage 1 needs a log with the link blocked"},
      {R"({"schema": "cablefit/campaign/1", "models": ["cubic"],
 "cells": [{"preload": "p", "blocked": ["b.csv"]}]})",
       ":1:46: unknown model 'cubic'; known: linear, poly"},
      {R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["b.csv"]}, {"preload": "p", "blocked": ["b.csv"]}]})",
       ":2:52: a second cell of preload 'p'; merge the two, or name the preloads "
       "differently"},
      {R"({"schema": "cablefit/campaign/1", "limits": {"rsd_percent": -1},
 "cells": [{"preload": "p", "blocked": ["b.csv"]}]})",
       ":1:61: 'limits.rsd_percent' is -1, not positive; give a number above 0"},
  };
  for (const BadCampaign& bad : cases) {
    const std::string path = folder.write("campaign.json", bad.text);
    CHECK(message_of([&] { read_campaign(path); }) == path + bad.message);
  }
}

}  // namespace
}  // namespace cablefit
