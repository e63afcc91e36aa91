// Reads back what RecordWriter wrote. Throws Error(input) for anything else. Internal to campaign/.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/json/json_document.hpp"

namespace cablefit {

class RecordReader {
 public:
  /// `node`: the struct to read. `paths`: what stands for the numbers of files in texts.
  RecordReader(const JsonNode& node, const std::vector<std::string>& paths)
      : node_(node), paths_(paths) {}

  template <class T>
  void operator()(std::string_view name, T& value) {
    read(node_.at(name), value);
  }
  void packed(std::string_view name, std::vector<double>& values);
  template <class Rows, class Row>
  void row(std::string_view name, const Rows& rows, const Row*& row) {
    const std::string& wanted = node_.at(name).text();
    row = wanted.empty() ? nullptr : &find_row(rows, name, wanted);
  }

 private:
  void read(const JsonNode& node, std::string& value) const;
  void read(const JsonNode& node, double& value) const;
  void read(const JsonNode& node, bool& value) const { value = node.boolean(); }
  void read(const JsonNode& node, Eigen::VectorXd& values) const;
  void read(const JsonNode& node, Eigen::MatrixXd& rows) const;

  template <class T>
  void read(const JsonNode& node, std::vector<T>& values) const {
    require_list(node);
    values.clear();
    values.reserve(node.items.size());
    for (const JsonNode& item : node.items) read(item, values.emplace_back());
  }
  template <class T>
  void read(const JsonNode& node, std::map<std::string, T>& values) const {
    values.clear();
    for (const JsonMember& member : node.members) read(member.second, values[member.first]);
  }
  template <class T>
  void read(const JsonNode& node, std::optional<T>& value) const {
    value.reset();
    if (!node.is_null()) read(node, value.emplace());
  }
  template <class T>
  void read(const JsonNode& node, T& value) const {
    if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
      value = static_cast<T>(static_cast<long long>(node.number()));
    } else {
      RecordReader reader(node, paths_);
      fields(reader, value);
    }
  }
  static void require_list(const JsonNode& node);

  const JsonNode& node_;
  const std::vector<std::string>& paths_;
};

}  // namespace cablefit
