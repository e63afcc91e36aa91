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
  folder.write("c.csv", "t,q\n");
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
       ":2:52: a second cell called 'p'; give them a different \"date\", \"robot\" or "
       "\"name\", or merge them"},
      {R"({"schema": "cablefit/campaign/1", "estimator": "wsl",
 "cells": [{"preload": "p", "blocked": ["b.csv"]}]})",
       ":1:48: unknown estimator 'wsl'; did you mean 'wls'?"},
      {R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["b.csv"], "validation": ["*.csv"]}]})",
       ":2:66: 'FOLDER/b.csv' is already a log of 'blocked'; name each log of "
       "a cell once"},
      {R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["b.csv"], "refine": true}]})",
       ":2:61: 'refine' has no model to start from; give the cell 'moving' logs: stage 2 makes the "
       "model"},
      {R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["b.csv"], "moving": ["c.csv"], "refine": 3}]})",
       ":2:82: 'refine' is neither true nor an object; write true, or {\"train\": "
       "[\"low/moving*.csv\"], \"test\": [..]}"},
      {R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["b.csv"], "moving": ["c.csv"], "refine": {"draws": 3}}]})",
       ":2:92: 'draws' is 3; give a whole number from 4 to 100000"},
      {R"({"schema": "cablefit/campaign/1", "limits": {"rsd_percent": -1},
 "cells": [{"preload": "p", "blocked": ["b.csv"]}]})",
       ":1:61: 'limits.rsd_percent' is -1, not positive; give a number above 0"},
  };
  for (const BadCampaign& bad : cases) {
    const std::string path = folder.write("campaign.json", bad.text);
    std::string expected = bad.message;
    if (const auto at = expected.find("FOLDER"); at != std::string::npos)
      expected.replace(at, 6, folder.path().string());
    CHECK(message_of([&] { read_campaign(path); }) == path + expected);
  }
}

TEST_CASE("dates are those of the calendar") {
  const TempFolder folder;
  folder.write("b.csv", "t,q\n");
  const auto read = [&](const std::string& date) {
    return read_campaign(folder.write("campaign.json",
                                      R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "p", "blocked": ["b.csv"], "date": ")" +
                                          date + "\"}]}"));
  };
  for (const char* date :
       {"2026-03-14", "2024-02-29", "2000-02-29", "2026-12-31T23:59", "2026-01-01T00:00:00"})
    CHECK(read(date).cells[0].date == date);
  for (const char* date :
       {"14.3.2026", "2026-3-14", "2026-02-29", "1900-02-29", "2026-13-01", "2026-00-10",
        "2026-04-31", "2026-01-00", "2026-01-01T24:00", "2026-01-01 10:00", ""})
    CHECK(message_of([&] { read(date); }) ==
          folder.file("campaign.json") + ":2:59: 'date' is '" + date +
              "', not a date; write \"2026-03-14\" or \"2026-03-14T09:30\"");
}

TEST_CASE("cells are called by their preload, and by what else tells them apart") {
  const TempFolder folder;
  folder.write("b.csv", "t,q\n");
  const Campaign campaign = read_campaign(folder.write("campaign.json",
                                                       R"({"schema": "cablefit/campaign/1",
 "cells": [{"preload": "low", "blocked": ["b.csv"], "date": "2026-01-01"},
           {"preload": "low", "blocked": ["b.csv"], "date": "2026-02-01"},
           {"preload": "low", "blocked": ["b.csv"], "robot": "arm 7"},
           {"preload": "low", "blocked": ["b.csv"], "name": "again"},
           {"preload": "high", "blocked": ["b.csv"], "robot": "arm 7"}]})"));
  std::vector<std::string> names;
  for (const CampaignCell& cell : campaign.cells) names.push_back(cell.name);
  CHECK(names == std::vector<std::string>{"low, 2026-01-01", "low, 2026-02-01", "arm 7, low",
                                          "again", "high"});
}

TEST_CASE("refine may name its own logs") {
  const TempFolder folder;
  for (const char* name : {"b.csv", "m1.csv", "m2.csv"}) folder.write(name, "t,q\n");
  const auto read = [&](const std::string& refine) {
    return read_campaign(folder.write("campaign.json",
                                      R"({"schema": "cablefit/campaign/1", "limits":
 {"new_effect": false}, "cells": [{"preload": "p", "blocked": ["b.csv"], "moving": ["m*.csv"],
 "refine": )" + refine + "}]}"));
  };
  CHECK(!read("true").limits.new_effect);
  CHECK(read("true").cells[0].refine->train.empty());
  CHECK(!read("false").cells[0].refine);
  const CampaignRefine refine =
      *read(R"({"train": ["m1.csv"], "test": ["m2.csv"], "draws": 8})").cells[0].refine;
  CHECK(refine.train == std::vector<std::string>{folder.file("m1.csv")});
  CHECK(refine.test == std::vector<std::string>{folder.file("m2.csv")});
  CHECK(refine.n_draws == 8);
}

}  // namespace
}  // namespace cablefit
