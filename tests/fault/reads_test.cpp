// A log that cannot be read to its end, or is not the same when it is read again.
#include <catch2/catch.hpp>
#include <cstdio>

#include "tests/fault/bench.hpp"

namespace {

using namespace cablefit::test;

const Arguments kElastic{"elastic", "log.csv", "--out", "out", "--quiet"};

TEST_CASE("a read that fails is told with the path, one that is interrupted goes on") {
  const FaultBench bench;
  const int n_reads = bench.count(kElastic).reads;
  const auto whole = bench.files();
  REQUIRE(n_reads > 5);
  for (int k = 1; k <= n_reads; ++k) {
    INFO("read " << k << " of " << n_reads);
    bench.reset({}, false);
    const Ended failed = bench.run(kElastic, {{"FAULT_READ", std::to_string(k) + ":EIO"}});
    INFO(failed.err);
    REQUIRE(failed.exit_code == 3);
    REQUIRE((failed.err == "cannot read log.csv: Input/output error\n" ||
             failed.err == "cannot read rig.json: Input/output error\n"));
    REQUIRE(bench.files().empty());
    const Ended interrupted = bench.run(kElastic, {{"FAULT_READ", std::to_string(k) + ":EINTR"}});
    REQUIRE(interrupted.exit_code == 0);
    REQUIRE(bench.files() == whole);
  }
  std::printf("    %d reads, each failing once and interrupted once\n", n_reads);
}

// The header is read first, then all of it, once: later passes take the samples kept from then.
TEST_CASE("a log that changes while it is read is refused") {
  const FaultBench bench;
  const int n_opens = bench.count(kElastic).opens;
  REQUIRE(n_opens == 2);
  for (const std::string how : {"truncate", "append", "replace"}) {
    for (int k = 2; k <= n_opens; ++k) {
      INFO(how << " before opening " << k << " of " << n_opens);
      bench.restore_log();
      bench.reset({}, false);
      const Ended ended = bench.run(kElastic, {{"FAULT_OPEN", std::to_string(k) + ":" + how}});
      REQUIRE(ended.exit_code == 3);
      REQUIRE(ended.err ==
              "log.csv: changed while it was being read; run again when no program writes to "
              "it\n");
      REQUIRE(bench.files().empty());
    }
  }
}

}  // namespace
