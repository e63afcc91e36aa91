#include "cablefit/campaign/cells/cell_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "cablefit/base/files/digest.hpp"
#include "cablefit/base/files/input_file.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/campaign/cells/record_reader.hpp"
#include "cablefit/campaign/cells/record_writer.hpp"
#include "cablefit/campaign/cells/result_fields.hpp"
#include "cablefit/version.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 28;
constexpr std::size_t kBlockBytes = std::size_t{1} << 16;
constexpr std::string_view kEnd = "}\n";

/// The part before the results. The digest detects a damaged file: nothing else would, where a
/// number lost a digit.
std::string head_of(std::string_view results, const CellKey& key) {
  return fmt::format(
      "{{\"schema\": \"cablefit/cell/1\", \"cablefit_version\": \"{}\", \"key\": \"{}\",\n"
      "\"sha256\": \"{}\",\n\"results\": ",
      kVersion, key.key, sha256_of_text(results));
}

Error not_this_cell() {
  return input_error({"results of a cell", 0, 0}, "not the results of this cell",
                     "delete the file; it will be made again");
}

std::string content_of(const std::string& path) {
  FileReader file(path);
  std::string text;
  std::vector<char> block(kBlockBytes);
  while (const std::size_t n = file.read(block.data(), block.size())) {
    text.append(block.data(), n);
    if (text.size() > kMostBytes) throw not_this_cell();
  }
  return text;
}

}  // namespace

std::string cell_path(const std::string& folder, const CellKey& key) {
  return (std::filesystem::path(folder) / (key.key + ".json")).string();
}

std::string cell_text(const CellResults& results, const CellKey& key) {
  RecordWriter writer(key.paths);
  writer.write_struct(results);
  const std::string text = writer.take();
  return head_of(text, key) + text + std::string(kEnd);
}

CellResults parse_cell(std::string_view text, const CellKey& key) {
  const std::size_t n_head = head_of("", key).size();  // as long as with any other digest
  if (text.size() < n_head + kEnd.size() || !text.ends_with(kEnd)) throw not_this_cell();
  const std::string_view results = text.substr(n_head, text.size() - n_head - kEnd.size());
  if (text.substr(0, n_head) != head_of(results, key)) throw not_this_cell();
  CellResults parsed;
  const JsonNode root = parse_json(results, "results of a cell");
  RecordReader reader(root, key.paths);
  fields(reader, parsed);
  return parsed;
}

std::optional<CellResults> read_cell_file(const std::string& path, const CellKey& key) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  try {
    return parse_cell(content_of(path), key);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace cablefit
