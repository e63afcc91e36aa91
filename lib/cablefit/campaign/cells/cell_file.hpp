// cablefit/cell/1: the results of one cell as a file, FOLDER/KEY.json. Not meant to be read by
// anything else: what people and programs want is in batch.json. Internal to campaign/.
#pragma once

#include <optional>
#include <string>

#include "cablefit/campaign/cells/cell_key.hpp"

namespace cablefit {

std::string cell_path(const std::string& folder, const CellKey& key);

/// All of the results, numbers bit for bit; paths as numbers of the key's files.
std::string cell_text(const CellResults& results, const CellKey& key);

/// From a text made by cell_text(). Throws Error(input) for anything else.
CellResults parse_cell(std::string_view text, const CellKey& key);

/// From the file; nothing when there is none, or none of this key that can be read: the cell is
/// then fitted again.
std::optional<CellResults> read_cell_file(const std::string& path, const CellKey& key);

}  // namespace cablefit
