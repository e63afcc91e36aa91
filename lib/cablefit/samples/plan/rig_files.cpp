#include "cablefit/samples/plan/rig_files.hpp"

#include <algorithm>
#include <string_view>

#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/json/json_document.hpp"

namespace cablefit {
namespace {

bool is_same(const JsonNode& a, const JsonNode& b);

bool is_same(const JsonNode* a, const JsonNode* b) {
  return a == nullptr || b == nullptr ? a == b : is_same(*a, *b);
}

/// Every member of `a` but `skipped` is the same in `b`.
bool has_members_of(const JsonNode& a, const JsonNode& b, std::string_view skipped = "") {
  return std::all_of(a.members.begin(), a.members.end(), [&](const JsonMember& member) {
    return member.first == skipped || is_same(&member.second, b.find(member.first));
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

}  // namespace

RigDifference compare_rig_files(const Rig& a, const Rig& b) {
  if (a.path == b.path) return RigDifference::none;
  if (a.path.empty() || b.path.empty()) return RigDifference::other;
  if (sha256_of_file(a.path) == sha256_of_file(b.path)) return RigDifference::none;
  constexpr std::string_view kLoad = "load";
  const JsonNode one = read_json_file(a.path), other = read_json_file(b.path);
  if (!has_members_of(one, other, kLoad) || !has_members_of(other, one, kLoad))
    return RigDifference::other;
  return is_same(one.find(kLoad), other.find(kLoad)) ? RigDifference::none : RigDifference::load;
}

}  // namespace cablefit
