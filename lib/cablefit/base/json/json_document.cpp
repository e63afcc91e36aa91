#include "cablefit/base/json/json_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/files/input_file.hpp"
#include "cablefit/base/json/json_events.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kReadBytes = 1u << 16;
constexpr std::size_t kMaxNodes = 400'000;
constexpr std::size_t kMaxParentBytes = 60;

// The path of a value below `parent`. Every value has one, so it stays short whatever the keys are.
std::string path_below(const std::string& parent, const std::string& step) {
  if (parent.size() <= kMaxParentBytes) return parent + step;
  return fmt::format("...{}{}", parent.substr(parent.size() - kMaxParentBytes), step);
}

// Builds the tree from the parser's events.
class TreeBuilder final : public JsonEvents {
 public:
  explicit TreeBuilder(const std::string& name) : name_(name) {}
  JsonNode take_root() { return std::move(root_); }

  void null(TextPosition at) override { add(JsonNode::Kind::null, at); }
  void boolean(bool value, TextPosition at) override {
    add(JsonNode::Kind::boolean, at).boolean_value = value;
  }
  void number(double value, TextPosition at) override {
    add(JsonNode::Kind::number, at).number_value = value;
  }
  void string(std::string& value, TextPosition at) override {
    add(JsonNode::Kind::string, at).string_value = std::move(value);
  }
  void start_object(TextPosition at) override {
    open_.push_back({&add(JsonNode::Kind::object, at), {}});
  }
  void start_array(TextPosition at) override {
    open_.push_back({&add(JsonNode::Kind::array, at), {}});
  }
  void end_object(TextPosition) override { open_.pop_back(); }
  void end_array(TextPosition) override { open_.pop_back(); }

  void key(std::string& name, TextPosition at) override {
    if (!open_.back().keys.insert(name).second) {
      throw input_error({name_, at.line, at.column}, "key " + in_quotes(name) + " appears twice",
                        "keep one of them");
    }
    open_.back().node->members.push_back({std::move(name), {}});
  }

 private:
  // A bracket that is not closed yet. Its node stays where it is: nodes are only appended to the
  // innermost one.
  struct Open {
    JsonNode* node;
    std::unordered_set<std::string> keys;
  };

  JsonNode& add(JsonNode::Kind kind, TextPosition at) {
    if (++n_nodes_ > kMaxNodes) {
      throw input_error({name_, at.line, at.column}, fmt::format("more than {} values", kMaxNodes),
                        "is this the right file?");
    }
    JsonNode& node = next_node();
    node.kind = kind;
    node.place = {name_, at.line, at.column};
    return node;
  }
  JsonNode& next_node() {
    if (open_.empty()) return root_;
    JsonNode& parent = *open_.back().node;
    if (parent.is_object()) {
      auto& [key, node] = parent.members.back();
      node.path = path_below(parent.path,
                             fmt::format("{}{}", parent.path.empty() ? "" : ".", shortened(key)));
      return node;
    }
    const std::size_t index = parent.items.size();
    parent.items.emplace_back().path = path_below(parent.path, fmt::format("[{}]", index));
    return parent.items.back();
  }

  const std::string& name_;
  JsonNode root_;
  std::size_t n_nodes_ = 0;
  std::vector<Open> open_;
};

JsonNode build_tree(const NextBlock& next_block, const std::string& name) {
  TreeBuilder builder(name);
  parse_json_events(next_block, name, builder);
  return builder.take_root();
}

std::string_view kind_name(JsonNode::Kind kind) {
  constexpr std::string_view names[] = {"null",   "true or false", "a number",
                                        "a text", "an array",      "an object"};
  return names[static_cast<std::size_t>(kind)];
}

// How a message calls a value; the outermost one has no path.
std::string label(const JsonNode& node) {
  return node.path.empty() ? "the document" : in_quotes(node.path);
}

std::string in_parent(const JsonNode& node) {
  return node.path.empty() ? "" : " in " + in_quotes(node.path);
}

void require_kind(const JsonNode& node, JsonNode::Kind kind, const std::string& hint) {
  if (node.kind == kind) return;
  throw node.error(
      fmt::format("{} is {}, not {}", label(node), kind_name(node.kind), kind_name(kind)), hint);
}

void require_object(const JsonNode& node) {
  require_kind(node, JsonNode::Kind::object, "write it as {\"key\": value}");
}

void require_array(const JsonNode& node, const std::string& example) {
  require_kind(node, JsonNode::Kind::array, "write it as " + example);
}

}  // namespace

const JsonNode* JsonNode::find(std::string_view key) const {
  require_object(*this);
  const auto found = std::find_if(members.begin(), members.end(),
                                  [&](const Member& member) { return member.first == key; });
  return found == members.end() ? nullptr : &found->second;
}

const JsonNode& JsonNode::at(std::string_view key) const {
  if (const JsonNode* member = find(key)) return *member;
  throw error("missing key " + in_quotes(key) + in_parent(*this), "add it to this object");
}

double JsonNode::number() const {
  require_kind(*this, Kind::number, "write numbers as 1.5 or -3e-4");
  return number_value;
}

double JsonNode::positive() const {
  const double value = number();
  if (value > 0) return value;
  throw error(fmt::format("{} is {}, not positive", label(*this), value), "give a number above 0");
}

bool JsonNode::boolean() const {
  require_kind(*this, Kind::boolean, "write true or false");
  return boolean_value;
}

const std::string& JsonNode::text() const {
  require_kind(*this, Kind::string, "write it in double quotes");
  return string_value;
}

std::vector<double> JsonNode::numbers() const {
  require_array(*this, "[1.5, -3e-4]");
  std::vector<double> values;
  for (const JsonNode& item : items) values.push_back(item.number());
  return values;
}

std::vector<std::string> JsonNode::texts() const {
  require_array(*this, "[\"a\", \"b\"]");
  std::vector<std::string> values;
  for (const JsonNode& item : items) values.push_back(item.text());
  return values;
}

void JsonNode::allow_only(std::initializer_list<std::string_view> keys) const {
  require_object(*this);
  for (const auto& [key, value] : members) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    throw value.error("unknown key " + in_quotes(key) + in_parent(*this), suggestion(key, keys));
  }
}

Error JsonNode::error(const std::string& what, const std::string& hint) const {
  return input_error(place, what, hint);
}

JsonNode read_json_file(const std::string& path, std::size_t max_bytes) {
  FileReader file(path);
  std::vector<char> block(kReadBytes);
  std::size_t n_total = 0;
  const NextBlock next_block = [&]() -> std::string_view {
    const std::size_t n_read = file.read(block.data(), block.size());
    n_total += n_read;
    if (n_total > max_bytes) {
      throw input_error({path}, fmt::format("larger than {} bytes", max_bytes),
                        "is this the right file?");
    }
    return {block.data(), n_read};
  };
  return build_tree(next_block, path);
}

JsonNode parse_json(std::string_view text, const std::string& name) {
  const NextBlock next_block = [&] { return std::exchange(text, std::string_view()); };
  return build_tree(next_block, name);
}

}  // namespace cablefit
