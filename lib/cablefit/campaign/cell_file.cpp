#include "cablefit/campaign/cell_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "cablefit/base/json_document.hpp"
#include "cablefit/campaign/record_reader.hpp"
#include "cablefit/campaign/record_writer.hpp"
#include "cablefit/campaign/result_fields.hpp"
#include "cablefit/version.hpp"

namespace cablefit {
namespace {

constexpr const char* kSchema = "cablefit/cell/1";
constexpr std::size_t kMostBytes = std::size_t{1} << 28;

struct CellFile {
  std::string schema, version, key;
  CellResults results;
};

template <class Archive>
void fields(Archive& a, CellFile& v) {
  a("schema", v.schema), a("cablefit_version", v.version), a("key", v.key);
  a("results", v.results);
}

CellResults from_document(const JsonNode& root, const CellKey& key) {
  CellFile file;
  RecordReader reader(root, key.paths);
  fields(reader, file);
  if (file.schema != kSchema || file.key != key.key)
    throw root.error("not the results of this cell", "delete the file, it is made anew");
  return std::move(file.results);
}

}  // namespace

std::string cell_path(const std::string& folder, const CellKey& key) {
  return (std::filesystem::path(folder) / (key.key + ".json")).string();
}

std::string cell_text(const CellResults& results, const CellKey& key) {
  RecordWriter writer(key.paths);
  writer.write_struct(CellFile{kSchema, kVersion, key.key, results});
  return writer.take() + "\n";
}

CellResults parse_cell(std::string_view text, const CellKey& key) {
  return from_document(parse_json(text, "results of a cell"), key);
}

std::optional<CellResults> read_cell_file(const std::string& path, const CellKey& key) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  try {
    return from_document(read_json_file(path, kMostBytes), key);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace cablefit
