// The rows of the table of maps of two joints, one per file. Internal to pair_maps.cpp; everybody
// else goes through pair_map_kinds().
#pragma once

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/pair_maps/pair_maps.hpp"

namespace cablefit::pair_maps {

/// Measured points with a bicubic spline between them.
PairMapKind grid();
/// A polynomial in both angles.
PairMapKind polynomial();
/// A straight tendon between two guides, over two joints in one plane.
PairMapKind guides();

/// A list of lists of numbers, all of one length.
Eigen::MatrixXd read_matrix(const JsonNode& node);
std::vector<std::vector<double>> lists_of(const Eigen::MatrixXd& matrix);

}  // namespace cablefit::pair_maps
