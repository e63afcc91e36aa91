// "joints" and "cables": the routing.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>

#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/rig/parts.hpp"
#include "cablefit/model/rig/searched_radius.hpp"

namespace cablefit::rig_parts {
namespace {

constexpr double kLongest = 1000;  // m (or rad); no pulley or cable of a robot comes near

/// `length` as it was read at `node`.
double sane(const JsonNode& node, std::string_view what, double length) {
  if (std::abs(length) < kLongest) return length;
  throw node.error(fmt::format("{} of {:g} m", what, length), "give it in m");
}

/// A number is the radius of a round pulley, an object any kind of map.
DisplacementMap read_map(const JsonNode& node) {
  if (node.is_number()) return round_pulley(sane(node, "a radius", node.number()));
  if (node.is_object() && node.find("search")) {
    throw node.error("this radius cannot be searched",
                     "search \"motor_radius\", and give this one in m");
  }
  if (!node.is_object()) {
    throw node.error("neither a radius nor a displacement map",
                     "give the signed radius in m, or {\"type\": \"polynomial\", ...}");
  }
  const JsonNode& type = node.at("type");
  const MapKind* kind = at_place_of(type, [&] { return &find_map_kind(type.text()); });
  DisplacementMap map{kind, kind->read(node)};
  for (const double angle : {-1.0, 0.0, 1.0}) sane(node, "a radius", map.radius(angle));
  return map;
}

/// Whether a sum of maps has other terms, so that no joint needs a radius of its own.
enum class Others { no, yes };

/// One map per joint; a single one counts as a list of one.
std::vector<DisplacementMap> read_maps(const JsonNode& node, int n_joints, Others others,
                                       DisplacementMap (*read)(const JsonNode&) = read_map) {
  std::vector<DisplacementMap> maps;
  if (node.is_array()) {
    for (const JsonNode& item : node.items) maps.push_back(read(item));
  } else {
    maps.push_back(read(node));
  }
  if (maps.size() != static_cast<std::size_t>(n_joints)) {
    throw node.error(fmt::format("{} number(s), expected {}", maps.size(), n_joints),
                     "give one per joint");
  }
  if (others == Others::no &&
      std::all_of(maps.begin(), maps.end(), std::mem_fn(&DisplacementMap::is_zero))) {
    throw node.error(
        "radius is 0",
        "give the signed radius in m, negative where a positive motion slackens the cable");
  }
  return maps;
}

/// {"search": r}: a round pulley whose radius is estimated from r on.
DisplacementMap read_searched(const JsonNode& node) {
  if (node.find("type")) {
    throw node.error("only the radius of a round pulley can be searched",
                     "give {\"search\": r} alone, or this map as it is");
  }
  node.allow_only({"search"});
  const JsonNode& start = node.at("search");
  const double radius = sane(start, "a radius", start.number());
  if (radius == 0) {
    throw start.error("a search of a radius cannot start from 0",
                      "give the signed nominal radius in m");
  }
  return searched_pulley(radius);
}

bool asks_search(const JsonNode& node) { return node.is_object() && node.find("search"); }

/// As read_maps(), also with one {"search": r}.
std::vector<DisplacementMap> read_motor_maps(const JsonNode& node, int n_joints, Others others) {
  const std::vector<JsonNode> alone{node};
  const std::vector<JsonNode>& items = node.is_array() ? node.items : alone;
  const JsonNode* searched = nullptr;
  for (const JsonNode& item : items) {
    if (item.is_string() && item.text() == "search")
      throw item.error("a search of a radius needs a value to start from",
                       "give {\"search\": r} with the signed nominal radius r in m");
    if (!asks_search(item)) continue;
    if (searched != nullptr)
      throw item.error("a second radius of this cable is searched",
                       "search one radius of a cable, and give the others in m");
    if (others == Others::yes)
      throw item.error("a searched radius beside motor_map",
                       "give the radius in m, or leave motor_map out");
    searched = &item;
  }
  return read_maps(node, n_joints, others, [](const JsonNode& item) {
    return asks_search(item) ? read_searched(item) : read_map(item);
  });
}

/// "joints" of a map of two joints: two different names, numbered from 0.
std::array<std::size_t, 2> read_two_joints(const JsonNode& node, const Rig& rig) {
  const JsonNode& names = node.at("joints");
  const std::vector<JsonNode>& items = some_items(names);
  if (items.size() != 2)
    throw names.error(fmt::format("{} joint(s), expected 2", items.size()),
                      "name the joints of angle 1 and angle 2");
  const std::vector<std::string_view> known(rig.joints.begin(), rig.joints.end());
  std::array<std::size_t, 2> joints{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto found = std::find(known.begin(), known.end(), items[k].text());
    if (found == known.end()) fail_unknown(items[k], "joint", items[k].text(), known);
    joints[k] = static_cast<std::size_t>(found - known.begin());
  }
  if (joints[0] == joints[1])
    throw items[1].error("both joints are the same",
                         "give a map of one joint in motor_radius or link_radius");
  return joints;
}

PairMap read_pair(const JsonNode& node, MapSide side, const Rig& rig) {
  const JsonNode& type = node.at("type");
  const PairMapKind* kind = at_place_of(type, [&] { return &find_pair_map_kind(type.text()); });
  PairMap map{kind, kind->read(node, side), read_two_joints(node, rig)};
  for (const std::size_t joint : map.joints)
    if (kind->rotary_only && rig.axes.of(static_cast<int>(joint)) == Axes::linear)
      throw type.error(
          fmt::format("map '{}' of joint '{}', which slides", kind->name, rig.joints[joint]),
          "it is of joints that turn: use \"grid\" or \"polynomial\"");
  for (const double angle : {-1.0, 0.0, 1.0})
    sane(node, "a radius", map.at(angle, angle).radius.cwiseAbs().maxCoeff());
  return map;
}

/// "motor_map" or "link_map": maps of two joints, or one of them.
std::vector<PairMap> read_pairs(const JsonNode* node, MapSide side, const Rig& rig) {
  std::vector<PairMap> pairs;
  if (node == nullptr) return pairs;
  if (!node->is_array()) return {read_pair(*node, side, rig)};
  for (const JsonNode& item : some_items(*node)) pairs.push_back(read_pair(item, side, rig));
  return pairs;
}

/// A side's maps of one joint and of two; the first may be left out where there are second.
void read_routing(const JsonNode& cable, const Rig& rig, Cable* to) {
  to->motor_pairs = read_pairs(cable.find("motor_map"), MapSide::motor, rig);
  to->link_pairs = read_pairs(cable.find("link_map"), MapSide::link, rig);
  const auto none = [&] { return round_pulleys(Eigen::VectorXd::Zero(rig.n_joints())); };
  const auto others = [](const std::vector<PairMap>& pairs) {
    return pairs.empty() ? Others::no : Others::yes;
  };
  const bool motor_alone = !to->motor_pairs.empty() && !cable.find("motor_radius");
  to->motor_map = motor_alone ? none()
                              : read_motor_maps(cable.at("motor_radius"), rig.n_joints(),
                                                others(to->motor_pairs));
  const bool link_alone = !to->link_pairs.empty() && !cable.find("link_radius");
  to->link_map = link_alone
                     ? none()
                     : read_maps(cable.at("link_radius"), rig.n_joints(), others(to->link_pairs));
}

/// "toe", which only laws with a toe have.
double read_toe(const JsonNode& cable, const CableLaw& law) {
  const JsonNode* toe = cable.find("toe");
  if (toe && !law.has_toe) {
    throw toe->error(fmt::format("a {} cable has no toe", law.name),
                     "use \"law\": \"strand\" or \"spline\", or drop it");
  }
  if (!law.has_toe) return 0;
  return cable.at("toe").positive();
}

int read_order(const JsonNode& cable, const CableLaw& law) {
  const JsonNode* node = cable.find("order");
  if (!node) return std::min(2, law.max_order);
  const double order = node->number();
  if (order != std::floor(order) || order < 1 || order > law.max_order) {
    throw node->error(fmt::format("order {} of a {} cable", order, law.name),
                      fmt::format("the order of a {} cable is a whole number from 1 to {}",
                                  law.name, law.max_order));
  }
  return static_cast<int>(order);
}

const CableLaw& read_law(const JsonNode& cable) {
  const JsonNode* node = cable.find("law");
  if (!node) return find_cable_law("polynomial");
  return at_place_of(*node, [&]() -> const CableLaw& { return find_cable_law(node->text()); });
}

/// "coefficients", for those who design with known cables; no fit looks at them. Their number is
/// the order's.
void read_coefficients(const JsonNode& node, Cable* cable) {
  const JsonNode* given = node.find("coefficients");
  if (!given) return;
  cable->coefficients = given->numbers();
  if (node.find("order") == nullptr)
    for (int order = 1; order <= cable->law->max_order; ++order)
      if (static_cast<std::size_t>(cable->law->n_coefficients(order)) == cable->coefficients.size())
        cable->order = order;
  if (cable->coefficients.size() == static_cast<std::size_t>(cable->n_coefficients())) return;
  throw given->error(fmt::format("{} coefficient(s) of a {} cable of order {}",
                                 cable->coefficients.size(), cable->law->name, cable->order),
                     fmt::format("give {}", cable->n_coefficients()));
}

/// "initial_elongation": a number (below 0: dead travel) or "search".
bool read_elongation(const JsonNode& cable, double* elongation) {
  const JsonNode* node = cable.find("initial_elongation");
  if (!node) return false;
  if (node->is_string()) {
    if (node->text() == "search") return true;
    throw node->error(fmt::format("unknown initial_elongation '{}'", node->text()),
                      "give a number in m, or \"search\" to estimate it");
  }
  *elongation = sane(*node, "an initial elongation", node->number());
  return false;
}

Cable read_cable(const JsonNode& node, const Rig& rig, bool* search) {
  node.allow_only({"name", "motor_radius", "link_radius", "motor_map", "link_map", "law", "order",
                   "toe", "coefficients", "initial_elongation"});
  Cable cable;
  read_routing(node, rig, &cable);
  cable.law = &read_law(node);
  cable.order = read_order(node, *cable.law);
  cable.toe = read_toe(node, *cable.law);
  read_coefficients(node, &cable);
  *search = read_elongation(node, &cable.initial_elongation);
  return cable;
}

}  // namespace

std::vector<std::string> read_joints(const JsonNode& node) {
  std::vector<std::string> joints;
  for (const JsonNode& joint : some_items(node)) {
    joint.allow_only({"name"});
    joints.push_back(unique_name(joint, joints));
  }
  return joints;
}

void read_cables(const JsonNode& node, Rig* rig) {
  rig->cables_given = true;
  rig->transmission.cables.clear();
  rig->search_elongation.clear();
  std::vector<std::string> names;
  for (const JsonNode& item : some_items(node)) {
    bool search = false;
    Cable cable = read_cable(item, *rig, &search);
    cable.name = names.emplace_back(unique_name(item, names));
    rig->transmission.cables.push_back(std::move(cable));
    rig->search_elongation.push_back(search);
  }
  // Maps need not be 0 at 0, and l = l_o there unless the file gives another pose.
  set_reference(rig->transmission, {});
}

ReferencePose read_reference(const JsonNode& node, int n_joints) {
  node.allow_only({"q", "theta"});
  const auto read = [&](const char* key) -> Eigen::VectorXd {
    const std::vector<double> values = n_numbers(node.at(key), n_joints);
    return Eigen::Map<const Eigen::VectorXd>(values.data(), n_joints);
  };
  return {read("q"), read("theta")};
}

}  // namespace cablefit::rig_parts
