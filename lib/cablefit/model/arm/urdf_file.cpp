#include "cablefit/model/arm/urdf_file.hpp"

#include "cablefit/base/error.hpp"

#ifndef CABLEFIT_URDF

namespace cablefit {

bool reads_urdf() { return false; }

UrdfTree read_urdf(const std::string& /*path*/) {
  throw Error(ErrorKind::input,
              "this cablefit was built without URDF; install libtinyxml2-dev and configure again, "
              "or give the chain by numbers with \"type\": \"serial\"");
}

}  // namespace cablefit

#else

#include <fast_float/fast_float.h>
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/files/input_file.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/model/arm/rigid_body.hpp"

namespace cablefit {
namespace {

using Eigen::Vector3d;
using tinyxml2::XMLElement;

constexpr std::size_t kMostBytes = 4u << 20;
constexpr std::size_t kMostLinks = 1000;

std::string text_of(const std::string& path) {
  FileReader file(path);
  std::string text(kMostBytes + 1, '\0');
  text.resize(file.read(text.data(), text.size()));
  if (text.size() > kMostBytes)
    throw input_error({path}, "larger than 4 MB", "a URDF names its meshes, it does not hold them");
  return text;
}

class Reader {
 public:
  explicit Reader(std::string path) { tree_.path = std::move(path); }

  UrdfTree read() {
    const std::string text = text_of(tree_.path);
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) fail_xml(document);
    const XMLElement* robot = document.FirstChildElement("robot");
    if (robot == nullptr)
      throw input_error({tree_.path, 1}, "no <robot>",
                        "is this file a URDF? xacro files have to "
                        "be expanded first");
    for (auto* e = robot->FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
      add_link(*e);
    for (auto* e = robot->FirstChildElement("joint"); e; e = e->NextSiblingElement("joint"))
      add_joint(*e);
    find_root();
    return std::move(tree_);
  }

 private:
  Place at(const XMLElement& e) const {
    return {tree_.path, static_cast<std::size_t>(std::max(0, e.GetLineNum()))};
  }

  [[noreturn]] void fail_xml(const tinyxml2::XMLDocument& document) const {
    std::string what = document.ErrorName();  // XML_ERROR_MISMATCHED_ELEMENT
    what = what.substr(what.starts_with("XML_ERROR_") ? 10 : 0);
    std::transform(what.begin(), what.end(), what.begin(), [](char c) {
      return c == '_' ? ' ' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    const auto line = static_cast<std::size_t>(std::max(0, document.ErrorLineNum()));
    throw input_error({tree_.path, line}, "not XML: " + what, "is this file a URDF?");
  }

  std::string attribute(const XMLElement& e, const char* name) const {
    const char* value = e.Attribute(name);
    if (value == nullptr || *value == '\0')
      throw input_error(at(e), fmt::format("<{}> has no {}", shortened(e.Name()), name), "");
    return value;
  }

  const XMLElement& child(const XMLElement& e, const char* name) const {
    const XMLElement* found = e.FirstChildElement(name);
    if (found == nullptr)
      throw input_error(at(e), fmt::format("<{}> has no <{}>", shortened(e.Name()), name), "");
    return *found;
  }

  template <std::size_t N>
  std::array<double, N> numbers(const XMLElement& e, const char* name) const {
    const std::string text = attribute(e, name);
    std::array<double, N> values{};
    std::size_t n = 0;
    const char *p = text.data(), *end = p + text.size();
    const auto skip = [&] {
      p = std::find_if(p, end,
                       [](char c) { return c != ' ' && c != '\t' && c != '\n' && c != '\r'; });
    };
    for (skip(); p != end; skip()) {
      if (*p == '+') ++p;
      double value = 0;
      const auto [rest, status] = fast_float::from_chars(p, end, value);
      if (status != std::errc() || !std::isfinite(value) || n == N) {
        n = N + 1;
        break;
      }
      values[n++] = value;
      p = rest;
    }
    if (n != N)
      throw input_error(
          at(e),
          fmt::format("{}={} is not {} number{}", name, in_quotes(text), N, N > 1 ? "s" : ""), "");
    return values;
  }

  Vector3d vector(const XMLElement& e, const char* name, const Vector3d& otherwise) const {
    if (e.Attribute(name) == nullptr) return otherwise;
    const auto [x, y, z] = numbers<3>(e, name);
    return {x, y, z};
  }

  void add_link(const XMLElement& e) {
    if (tree_.links.size() == kMostLinks)
      throw input_error(at(e), fmt::format("more than {} links", kMostLinks), "");
    UrdfLink link;
    link.name = attribute(e, "name");
    if (index_of(tree_.links, link.name) < tree_.links.size())
      throw input_error(at(e), fmt::format("link {} appears twice", in_quotes(link.name)), "");
    if (const XMLElement* inertial = e.FirstChildElement("inertial"))
      link.inertia = inertia_of(*inertial, link.name);
    tree_.links.push_back(std::move(link));
  }

  LinkInertia inertia_of(const XMLElement& e, const std::string& link) const {
    const XMLElement& tensor = child(e, "inertia");
    LinkInertia about_centre = LinkInertia::Zero();
    about_centre(0) = numbers<1>(child(e, "mass"), "value")[0];
    Eigen::Index next = 4;
    for (const char* name : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
      about_centre(next++) = numbers<1>(tensor, name)[0];
    if (const BodyFault fault = body_fault(about_centre); !fault.what.empty())
      throw input_error(at(e), fmt::format("link {} has {}", in_quotes(link), fault.what),
                        fault.remedy);
    Vector3d origin = Vector3d::Zero(), rpy = Vector3d::Zero();
    if (const XMLElement* pose = e.FirstChildElement("origin")) {
      origin = vector(*pose, "xyz", origin);
      rpy = vector(*pose, "rpy", rpy);
    }
    return moved(about_centre, rotation_of(rpy), origin);
  }

  template <typename Named>
  static std::size_t index_of(const std::vector<Named>& all, std::string_view name) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Named& each) { return each.name == name; });
    return static_cast<std::size_t>(found - all.begin());
  }

  std::size_t link_at(const XMLElement& joint, const char* which) const {
    const XMLElement& e = child(joint, which);
    const std::string name = attribute(e, "link");
    const std::size_t index = index_of(tree_.links, name);
    if (index < tree_.links.size()) return index;
    std::vector<std::string_view> known;
    for (const UrdfLink& link : tree_.links) known.push_back(link.name);
    throw input_error(at(e), fmt::format("unknown link {}", in_quotes(name)),
                      suggestion(name, known));
  }

  void add_joint(const XMLElement& e) {
    UrdfJoint joint;
    joint.name = attribute(e, "name");
    joint.line = at(e).line;
    if (index_of(tree_.joints, joint.name) < tree_.joints.size())
      throw input_error(at(e), fmt::format("joint {} appears twice", in_quotes(joint.name)), "");
    joint.type = attribute(e, "type");
    joint.motion = joint.type == "revolute" || joint.type == "continuous" ? UrdfMotion::turns
                   : joint.type == "prismatic"                            ? UrdfMotion::slides
                   : joint.type == "fixed"                                ? UrdfMotion::fixed
                                                                          : UrdfMotion::other;
    if (const XMLElement* mimic = e.FirstChildElement("mimic"))
      joint.mimics = attribute(*mimic, "joint");
    joint.parent = link_at(e, "parent");
    joint.child = link_at(e, "child");
    if (const XMLElement* pose = e.FirstChildElement("origin")) {
      joint.origin = vector(*pose, "xyz", joint.origin);
      joint.rpy = vector(*pose, "rpy", joint.rpy);
    }
    if (const XMLElement* axis = e.FirstChildElement("axis")) {
      joint.axis = vector(*axis, "xyz", joint.axis);
      if (joint.axis.isZero(0)) throw input_error(at(*axis), "an axis of length 0", "");
      joint.axis = unit_axis(joint.axis);
    }
    hang(e, joint);
  }

  /// The joint's child on the joint.
  void hang(const XMLElement& e, const UrdfJoint& joint) {
    UrdfLink& link = tree_.links[joint.child];
    if (link.joint >= 0)
      throw input_error(at(e), fmt::format("link {} has two parent joints", in_quotes(link.name)),
                        "a URDF is a tree: every link has one parent");
    link.joint = static_cast<std::ptrdiff_t>(tree_.joints.size());
    tree_.links[joint.parent].children.push_back(tree_.joints.size());
    tree_.joints.push_back(joint);
  }

  void find_root() {
    const auto is_root = [](const UrdfLink& link) { return link.joint < 0; };
    const auto n = std::count_if(tree_.links.begin(), tree_.links.end(), is_root);
    if (n != 1)
      throw input_error({tree_.path}, fmt::format("{} links have no parent joint", n),
                        "a URDF is a tree: one link, the root, has no parent");
    const auto root = std::find_if(tree_.links.begin(), tree_.links.end(), is_root);
    tree_.root = static_cast<std::size_t>(root - tree_.links.begin());
    std::vector<std::size_t> reached{tree_.root};
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (const std::size_t joint : tree_.links[reached[k]].children)
        reached.push_back(tree_.joints[joint].child);
    if (reached.size() < tree_.links.size())
      throw input_error({tree_.path}, "some joints form a loop",
                        "a URDF is a tree: every link descends from the root");
  }

  UrdfTree tree_;
};

}  // namespace

bool reads_urdf() { return true; }

UrdfTree read_urdf(const std::string& path) { return Reader(path).read(); }

}  // namespace cablefit

#endif
