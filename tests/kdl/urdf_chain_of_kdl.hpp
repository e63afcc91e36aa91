// Reads a URDF file into a chain of KDL, apart from the library's own reader: only what lies
// between base and tip, with the conventions of https://wiki.ros.org/urdf/XML.
#pragma once

#include <tinyxml2.h>

#include <kdl/chain.hpp>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace cablefit::test {

inline double number_of(const tinyxml2::XMLElement* element, const char* name) {
  return element == nullptr ? 0 : element->DoubleAttribute(name);
}

inline KDL::Vector vector_of(const tinyxml2::XMLElement* element, const char* name) {
  const char* text = element == nullptr ? nullptr : element->Attribute(name);
  KDL::Vector v = KDL::Vector::Zero();
  if (text == nullptr) return v;
  std::istringstream numbers(text);
  numbers >> v[0] >> v[1] >> v[2];
  return v;
}

inline KDL::Frame origin_of(const tinyxml2::XMLElement& element) {
  const tinyxml2::XMLElement* origin = element.FirstChildElement("origin");
  const KDL::Vector rpy = vector_of(origin, "rpy");
  return {KDL::Rotation::RPY(rpy[0], rpy[1], rpy[2]), vector_of(origin, "xyz")};
}

inline KDL::RigidBodyInertia inertia_of(const tinyxml2::XMLElement& link) {
  const tinyxml2::XMLElement* inertial = link.FirstChildElement("inertial");
  if (inertial == nullptr) return KDL::RigidBodyInertia::Zero();
  const KDL::Frame centre = origin_of(*inertial);
  const tinyxml2::XMLElement* i = inertial->FirstChildElement("inertia");
  const KDL::RotationalInertia own(number_of(i, "ixx"), number_of(i, "iyy"), number_of(i, "izz"),
                                   number_of(i, "ixy"), number_of(i, "ixz"), number_of(i, "iyz"));
  const KDL::RigidBodyInertia turned =
      centre.M * KDL::RigidBodyInertia(0, KDL::Vector::Zero(), own);
  return KDL::RigidBodyInertia(number_of(inertial->FirstChildElement("mass"), "value"), centre.p,
                               turned.getRotationalInertia());
}

inline KDL::Joint joint_of(const tinyxml2::XMLElement& joint, const KDL::Frame& origin) {
  const std::string name = joint.Attribute("name"), type = joint.Attribute("type");
  if (type == "fixed") return KDL::Joint(name, KDL::Joint::Fixed);
  const KDL::Vector axis = origin.M * vector_of(joint.FirstChildElement("axis"), "xyz");
  if (type == "prismatic") return KDL::Joint(name, origin.p, axis, KDL::Joint::TransAxis);
  if (type == "revolute" || type == "continuous")
    return KDL::Joint(name, origin.p, axis, KDL::Joint::RotAxis);
  throw std::runtime_error("joint type " + type);
}

inline KDL::Chain kdl_chain(const std::string& urdf, const std::string& base,
                            const std::string& tip) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str()) != tinyxml2::XML_SUCCESS)
    throw std::runtime_error(document.ErrorStr());
  const tinyxml2::XMLElement* robot = document.RootElement();
  std::map<std::string, const tinyxml2::XMLElement*> links, joints;  // joints by their child
  for (auto* e = robot->FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
    links[e->Attribute("name")] = e;
  for (auto* e = robot->FirstChildElement("joint"); e; e = e->NextSiblingElement("joint"))
    joints[e->FirstChildElement("child")->Attribute("link")] = e;
  std::vector<std::string> names;  // from the tip
  for (std::string at = tip; at != base;
       at = joints.at(at)->FirstChildElement("parent")->Attribute("link"))
    names.push_back(at);
  KDL::Chain chain;
  for (auto name = names.rbegin(); name != names.rend(); ++name) {
    const KDL::Frame origin = origin_of(*joints.at(*name));
    chain.addSegment(KDL::Segment(*name, joint_of(*joints.at(*name), origin), origin,
                                  inertia_of(*links.at(*name))));
  }
  return chain;
}

}  // namespace cablefit::test
