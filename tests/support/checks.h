#pragma once

#include <cstddef>

#include "limn/mesh/mesh.h"

namespace limn::test {

/// Edges told apart by the coordinates of their ends (-0 equals 0), counted with ordered maps: slow and plain, the
/// oracle for build_topology(). Faces with two corners at one place take no part.
struct EdgeCounts {
  std::size_t edges = 0;
  std::size_t boundary = 0;      ///< one face
  std::size_t manifold = 0;      ///< two faces, opposite directions
  std::size_t inconsistent = 0;  ///< two faces, the same direction
  std::size_t non_manifold = 0;  ///< three faces or more
};
EdgeCounts count_edges(const Mesh& mesh);

/// Distinct positions that faces use.
std::size_t count_used_positions(const Mesh& mesh);

/// Volume enclosed, by the divergence theorem, in double; positive when faces wind counter-clockwise outside.
double signed_volume(const Mesh& mesh);

/// The smallest area of a face; 0 when one is degenerate, infinite for no faces.
double smallest_face_area(const Mesh& mesh);

/// The smallest cosine, over all corners, between a corner's normal and its face's; 1 for no faces. \pre has normals
double worst_normal_agreement(const Mesh& mesh);

/// Every index in range, attribute counts consistent, every number finite, normals of unit length to 1e-5.
void expect_well_formed(const Mesh& mesh);

/// Every edge has two faces that run along it in opposite directions, by position; at least one face.
void expect_closed(const Mesh& mesh);

/// Equal in every bit: positions, faces, attributes, tags, materials' numbers.
void expect_same_bits(const Mesh& a, const Mesh& b);

}  // namespace limn::test
