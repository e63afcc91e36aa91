#include "cablefit/campaign/cells/record_reader.hpp"

#include <bit>
#include <cstdint>
#include <limits>

#include "cablefit/base/base64.hpp"
#include "cablefit/campaign/cells/portable_text.hpp"

namespace cablefit {
namespace {

constexpr const char* kHint = "delete the file; it will be made again";

double number_at(std::string_view bytes) {
  std::uint64_t bits = 0;
  for (std::size_t k = 8; k-- > 0;) bits = bits << 8u | static_cast<unsigned char>(bytes[k]);
  return std::bit_cast<double>(bits);
}

}  // namespace

void RecordReader::require_list(const JsonNode& node) {
  if (!node.is_array()) throw node.error("not a list", kHint);
}

void RecordReader::read(const JsonNode& node, std::string& value) const {
  value = text_here(node.text(), paths_);
}

void RecordReader::read(const JsonNode& node, double& value) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!node.is_string())
    value = node.number();
  else if (node.string_value == "nan")
    value = std::numeric_limits<double>::quiet_NaN();
  else if (node.string_value == "inf" || node.string_value == "-inf")
    value = node.string_value == "inf" ? kInfinity : -kInfinity;
  else
    throw node.error("not a number", kHint);
}

void RecordReader::read(const JsonNode& node, Eigen::VectorXd& values) const {
  std::vector<double> numbers;
  read(node, numbers);
  values = Eigen::Map<Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

void RecordReader::read(const JsonNode& node, Eigen::MatrixXd& rows) const {
  std::vector<Eigen::VectorXd> all;
  read(node, all);
  rows.resize(static_cast<Eigen::Index>(all.size()), all.empty() ? 0 : all.front().size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].size() != rows.cols()) throw node.error("rows of different lengths", kHint);
    rows.row(static_cast<Eigen::Index>(i)) = all[i];
  }
}

void RecordReader::packed(std::string_view name, std::vector<double>& values) {
  const JsonNode& node = node_.at(name);
  require_list(node);
  values.clear();
  for (const JsonNode& item : node.items) {
    const auto bytes = from_base64(item.text());
    if (!bytes || bytes->size() % 8 != 0) throw item.error("not packed numbers", kHint);
    for (std::size_t k = 0; k < bytes->size(); k += 8)
      values.push_back(number_at(std::string_view(*bytes).substr(k, 8)));
  }
}

}  // namespace cablefit
