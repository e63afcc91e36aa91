#include "cablefit/samples/plan/rig_files.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/json/json_document.hpp"

namespace cablefit {
namespace {

bool is_same(const JsonNode& a, const JsonNode& b);

bool is_same(const JsonNode* a, const JsonNode* b) {
  return a == nullptr || b == nullptr ? a == b : is_same(*a, *b);
}

bool has_members_of(const JsonNode& a, const JsonNode& b) {
  return std::all_of(a.members.begin(), a.members.end(), [&](const JsonMember& member) {
    return is_same(&member.second, b.find(member.first));
  });
}

bool is_same(const JsonNode& a, const JsonNode& b) {
  if (a.kind != b.kind || a.boolean_value != b.boolean_value || a.number_value != b.number_value ||
      a.string_value != b.string_value)
    return false;
  if (a.is_object()) return a.members.size() == b.members.size() && has_members_of(a, b);
  return std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(),
                    [](const JsonNode& one, const JsonNode& other) { return is_same(one, other); });
}

constexpr std::string_view kLoad = "load", kLabel = "name";

/// The first key of `a`, but for load and label, that `b` does not have the same; empty: none.
std::string changed_key(const JsonNode& a, const JsonNode& b) {
  for (const JsonMember& member : a.members)
    if (member.first != kLoad && member.first != kLabel &&
        !is_same(&member.second, b.find(member.first)))
      return member.first;
  return "";
}

}  // namespace

RigComparison compare_rig_files(const Rig& a, const Rig& b) {
  if (a.path == b.path) return {};
  if (a.path.empty() || b.path.empty()) return {RigDifference::other, ""};
  if (sha256_of_file(a.path) == sha256_of_file(b.path)) return {};
  const JsonNode one = read_json_file(a.path), other = read_json_file(b.path);
  std::string key = changed_key(one, other);
  if (key.empty()) key = changed_key(other, one);
  if (!key.empty()) return {RigDifference::other, std::move(key)};
  return {is_same(one.find(kLoad), other.find(kLoad)) ? RigDifference::none : RigDifference::load,
          ""};
}

}  // namespace cablefit
