#include "cablefit/log/byte_source.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/log/log_support.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

using test::gzipped;
using test::TempFolder;
using test::zstd_packed;

std::string unpack(const std::string& path, std::size_t n_at_once = 1u << 16) {
  const auto source = open_bytes(path);
  std::string text;
  std::string block(n_at_once, '\0');
  while (const std::size_t n_read = source->read(block.data(), n_at_once)) {
    text.append(block, 0, n_read);
  }
  return text;
}

std::string unpack_message(const TempFolder& folder, const std::string& content) {
  const std::string path = folder.write("log", content);
  return test::message_of([&] { unpack(path); }, folder.path());
}

// Random digits: packing leaves many blocks of it.
std::string long_text(std::size_t n_bytes = 1'000'000) {
  std::mt19937 random(1);
  std::string text;
  while (text.size() < n_bytes) text += std::to_string(random()) + '\n';
  return text;
}

}  // namespace

TEST_CASE("plain, gzip and zstd are told apart by their first bytes") {
  const TempFolder folder;
  const std::string text = long_text();
  const std::size_t n_at_once = GENERATE(7, 4096, 1u << 22);
  CHECK(unpack(folder.write("a.gz", text), n_at_once) == text);
  CHECK(unpack(folder.write("b.csv", gzipped(text)), n_at_once) == text);
  CHECK(unpack(folder.write("c", zstd_packed(text)), n_at_once) == text);
  CHECK(unpack(folder.write("d", "")).empty());
  CHECK(unpack(folder.write("e", gzipped(""))).empty());
  CHECK(unpack(folder.write("f", zstd_packed(""))).empty());
}

TEST_CASE("looking at the head takes nothing away") {
  const TempFolder folder;
  const auto source = open_bytes(folder.write("log", "t,q\n0,1\n"));
  CHECK(source->peek(3) == "t,q");
  CHECK(source->peek(1) == "t");
  CHECK(source->peek(100) == "t,q\n0,1\n");
  std::string text(100, '\0');
  text.resize(source->read(text.data(), text.size()));
  CHECK(text == "t,q\n0,1\n");
  CHECK(source->read(text.data(), 1) == 0);
}

TEST_CASE("concatenated members and frames are one text") {
  const TempFolder folder;
  const std::string a = long_text(200'000);
  const std::string b = "end\n";
  CHECK(unpack(folder.write("a", gzipped(a) + gzipped("") + gzipped(b))) == a + b);
  CHECK(unpack(folder.write("b", zstd_packed(a) + zstd_packed("") + zstd_packed(b))) == a + b);
  const std::string skippable("\x50\x2a\x4d\x18\x04\x00\x00\x00note", 12);
  CHECK(unpack(folder.write("c", skippable + zstd_packed(a) + skippable)) == a);
}

TEST_CASE("truncated data says how much of it was good") {
  const TempFolder folder;
  const std::string text = "t,q\n0,1\n";
  const std::string packed = gzipped(text);
  CHECK(unpack_message(folder, packed.substr(0, packed.size() - 1)) ==
        "log: gzip data ends early after 8 good bytes; copy the file again");
  CHECK(unpack_message(folder, packed.substr(0, 5)) ==
        "log: gzip data ends early after 0 good bytes; copy the file again");
  CHECK(unpack_message(folder, packed + packed.substr(0, 5)) ==
        "log: gzip data ends early after 8 good bytes; copy the file again");
  const std::string frame = zstd_packed(text);
  CHECK(unpack_message(folder, frame.substr(0, frame.size() - 1)) ==
        "log: zstd data ends early after 7 good bytes; copy the file again");
  CHECK(unpack_message(folder, frame + frame.substr(0, 6)) ==
        "log: zstd data ends early after 8 good bytes; copy the file again");
}

TEST_CASE("every truncation of a packed file is noticed") {
  const TempFolder folder;
  const std::string text = long_text(3'000);
  for (const std::string& packed : {gzipped(text), zstd_packed(text)}) {
    for (std::size_t n = 4; n < packed.size(); ++n) {
      const std::string message = unpack_message(folder, packed.substr(0, n));
      REQUIRE(message.find("data ends early after") != std::string::npos);
    }
  }
}

TEST_CASE("corrupt data and garbage are errors") {
  const TempFolder folder;
  const std::string packed = gzipped("t,q\n0,1\n");
  CHECK(unpack_message(folder, packed + "garbage") ==
        "log: gzip data is corrupt after 8 good bytes (garbage at its end); copy the file again");
  std::string wrong_sum = packed;
  wrong_sum[wrong_sum.size() - 8] ^= 1;
  CHECK(unpack_message(folder, wrong_sum) ==
        "log: gzip data is corrupt after 8 good bytes (incorrect data check); copy the file "
        "again");
  CHECK(unpack_message(folder, zstd_packed("t,q\n0,1\n") + "garbage") ==
        "log: zstd data is corrupt after 8 good bytes (Unknown frame descriptor); copy the file "
        "again");
}

TEST_CASE("a zstd frame may not ask for more than 128 MiB of memory") {
  const TempFolder folder;
  // Frame header: no content size, window descriptor 0x98 = 2^(10 + 19) bytes (RFC
  // 8878, 3.1.1.1.2).
  const std::string greedy("\x28\xb5\x2f\xfd\x00\x98\x01\x00\x00", 9);
  CHECK(unpack_message(folder, greedy) ==
        "log: zstd data is corrupt after 0 good bytes (Frame requires too much memory for "
        "decoding); copy the file again");
}

TEST_CASE("files that cannot be read are errors") {
  CHECK(test::message_of([] { open_bytes("no/log.csv"); }) ==
        "cannot read no/log.csv: No such file or directory");
  const TempFolder folder;
  CHECK(test::message_of([&] { open_bytes(folder.path()); }) ==
        "cannot read " + folder.path().string() + ": Is a directory");
}

TEST_CASE("the table of compressions has names") {
  for (const Compression& row : compressions()) CHECK_FALSE(row.name.empty());
}

}  // namespace cablefit
