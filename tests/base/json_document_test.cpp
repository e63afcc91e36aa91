#include "cablefit/base/json/json_document.hpp"

#include <catch2/catch.hpp>

#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

using test::message_of;

std::string parse_message(const std::string& text) {
  return message_of([&] { parse_json(text, "rig.json"); });
}

template <typename Read>
std::string read_message(const std::string& text, Read read) {
  return message_of([&] { read(parse_json(text, "rig.json")); });
}

}  // namespace

TEST_CASE("a document is a tree with places and paths") {
  const JsonNode root = parse_json(
      "{ // a comment\n"
      "  \"name\": \"bench 3\", /* another * \" */\n"
      "  \"joints\": [{\"name\": \"1\"}, {\"name\": \"2\", \"zero\":-1.5e-1}],\n"
      "  \"on\": true, \"off\": null }",
      "rig.json");
  CHECK(to_string(root.place) == "rig.json:1:1");
  CHECK(root.at("name").text() == "bench 3");
  CHECK(to_string(root.at("name").place) == "rig.json:2:11");
  const JsonNode& zero = root.at("joints").items.at(1).at("zero");
  CHECK(zero.number() == -0.15);
  CHECK(zero.path == "joints[1].zero");
  CHECK(to_string(zero.place) == "rig.json:3:50");
  CHECK(to_string(root.at("joints").items[1].place) == "rig.json:3:29");
  CHECK(root.at("on").boolean());
  CHECK(root.at("off").is_null());
  CHECK(to_string(root.at("off").place) == "rig.json:4:22");
  CHECK(root.find("none") == nullptr);
}

TEST_CASE("a byte order mark and escapes are understood") {
  CHECK(parse_json("\xef\xbb\xbf[\"a\\\"b\\n\\u00b0\"]", "x").items[0].text() == "a\"b\n°");
  CHECK(to_string(parse_json("[\"a\\\\\", 17 ]", "x").items[1].place) == "x:1:9");
}

TEST_CASE("arrays of one type are read at once") {
  CHECK(parse_json("[1, 2.5, 18446744073709551615]", "x").numbers() ==
        std::vector<double>{1, 2.5, 18446744073709551615.0});
  CHECK(parse_json("[\"a\", \"b\"]", "x").texts() == std::vector<std::string>{"a", "b"});
}

TEST_CASE("syntax errors are told in our words, at the token") {
  CHECK(parse_message("{\"a\": 1,\n \"b\" 2}") ==
        "rig.json:2:6: unexpected number literal; put ':' between key and value");
  CHECK(parse_message("{\"a\": 1 \"b\": 2}") ==
        "rig.json:1:9: unexpected string literal; put ',' between members and '}' after the last");
  CHECK(parse_message("[1 2]") ==
        "rig.json:1:4: unexpected number literal; put ',' between values and ']' after the last");
  CHECK(parse_message("{\"a\": 1,}") ==
        "rig.json:1:9: unexpected '}'; expected a key in double quotes");
  CHECK(parse_message("[1, ]") == "rig.json:1:5: unexpected ']'; expected a value");
  CHECK(parse_message("[] []") ==
        "rig.json:1:4: unexpected '['; nothing may follow the closing bracket");
  CHECK(parse_message("[1,\n 2") ==
        "rig.json:2:3: text ends too early; close all brackets, or copy the file again");
  CHECK(parse_message("") ==
        "rig.json:1:1: text ends too early; close all brackets, or copy the file again");
  CHECK(parse_message("[\"abc") ==
        "rig.json:1:2: text is not closed; add a double quote at its end");
  CHECK(parse_message("[\"a\nb\"]") ==
        "rig.json:1:2: line break or control character in a text; write it as \\n, \\t or "
        "\\u0001");
  CHECK(parse_message("[\"\xff\"]") == "rig.json:1:2: text is not UTF-8; save the file as UTF-8");
  CHECK(parse_message("[\"C:\\data\"]") ==
        "rig.json:1:2: bad escape in a text; write a backslash as \\\\");
  CHECK(parse_message("[1] /* open") ==
        "rig.json:1:5: comment is not closed; write /* .. */ or // ..");
  CHECK(parse_message("[1.]") ==
        "rig.json:1:2: number is not complete; write numbers as 1.5 or -3e-4");
  CHECK(parse_message("[tru]") ==
        "rig.json:1:2: no JSON value starts like this; write texts in "
        "double quotes, numbers as 1.5 or -3e-4");
  CHECK(parse_message("[1e999]") == "rig.json:1:2: number is too large; the largest is 1.8e308");
  const std::string no_value =
      "no JSON value starts like this; write texts in double quotes, numbers as 1.5 or -3e-4";
  CHECK(parse_message("[1, nan]") == "rig.json:1:5: " + no_value);
  CHECK(parse_message("['a']") == "rig.json:1:2: " + no_value);
  CHECK(parse_message("{\u201ca\u201d: 1}") == "rig.json:1:2: " + no_value);
}

TEST_CASE("duplicate keys and deep nesting are errors") {
  CHECK(parse_message("{\"a\": 1,\n \"a\": 2}") ==
        "rig.json:2:2: key 'a' appears twice; keep one of them");
  CHECK(parse_message(std::string(64, '[') + std::string(64, ']')) == "no error");
  CHECK(parse_message(std::string(1000, '[')) ==
        "rig.json:1:65: more than 64 levels of brackets; nest the values less deeply");
}

TEST_CASE("typed reads say what was expected and where") {
  using Node = const JsonNode&;
  CHECK(read_message("[1]", [](Node n) { n.find("a"); }) ==
        "rig.json:1:1: the document is an array, not an object; write it as {\"key\": value}");
  CHECK(read_message("{\"a\": {}}", [](Node n) { n.at("a").at("b"); }) ==
        "rig.json:1:7: missing key 'b' in 'a'; add it to this object");
  CHECK(read_message("{}", [](Node n) { n.at("b"); }) ==
        "rig.json:1:1: missing key 'b'; add it to this object");
  CHECK(read_message("[\"1\"]", [](Node n) { n.items[0].number(); }) ==
        "rig.json:1:2: '[0]' is a text, not a number; write numbers as 1.5 or -3e-4");
  CHECK(read_message("{\"a\": [1, null]}", [](Node n) { n.at("a").numbers(); }) ==
        "rig.json:1:11: 'a[1]' is null, not a number; write numbers as 1.5 or -3e-4");
  CHECK(read_message("{\"a\": 1}", [](Node n) { n.at("a").numbers(); }) ==
        "rig.json:1:7: 'a' is a number, not an array; write it as [1.5, -3e-4]");
  CHECK(read_message("{\"a\": 1}", [](Node n) { n.at("a").texts(); }) ==
        "rig.json:1:7: 'a' is a number, not an array; write it as [\"a\", \"b\"]");
  CHECK(read_message("{\"a\": -1}", [](Node n) { n.at("a").positive(); }) ==
        "rig.json:1:7: 'a' is -1, not positive; give a number above 0");
  CHECK(read_message("{\"a\": 1}", [](Node n) { n.at("a").boolean(); }) ==
        "rig.json:1:7: 'a' is a number, not true or false; write true or false");
  CHECK(read_message("{\"a\": true}", [](Node n) { n.at("a").text(); }) ==
        "rig.json:1:7: 'a' is true or false, not a text; write it in double quotes");
}

TEST_CASE("unknown keys are reported with a near match") {
  const auto allow = [](const JsonNode& node) { node.at("a").allow_only({"preload", "name"}); };
  CHECK(read_message("{\"a\": {\"name\": 1}}", allow) == "no error");
  CHECK(read_message("{\"a\": {\"preloda\": 1}}", allow) ==
        "rig.json:1:19: unknown key 'preloda' in 'a'; did you mean 'preload'?");
  CHECK(read_message("{\"a\": {\"x\": 1}}", allow) ==
        "rig.json:1:13: unknown key 'x' in 'a'; known: preload, name");
}

TEST_CASE("files are read in blocks, up to a size") {
  const test::TempFolder folder;
  const std::string path = folder.write("big.json", "[\n" + std::string(200'000, ' ') + "7]");
  CHECK(to_string(read_json_file(path).items[0].place) == path + ":2:200001");
  CHECK(message_of([&] { read_json_file(path, 100'000); }) ==
        path + ": larger than 100000 bytes; is this the right file?");
  CHECK(message_of([] { read_json_file("no/rig.json"); }) ==
        "cannot read no/rig.json: No such file or directory");
}

}  // namespace cablefit
