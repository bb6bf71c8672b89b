#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "limn/mesh/mesh.h"

namespace limn::asset {

/// The positions and faces of a mesh in few bytes, every bit of them kept: the order of vertices and faces, which
/// corner a face begins with, and each coordinate (docs/asset.md). About 3 bytes a triangle for scans, in the
/// order of order_for_storage(); any other order is kept as well, in more bytes.
/// Same mesh, same bytes. Cost: about 0.2 µs a face. \pre indices in range
std::vector<std::byte> encode_mesh(const Mesh& mesh);

/// The mesh that was encoded. Nothing when the bytes are not those of a mesh with so many vertices and faces; then
/// memory and time have stayed within a multiple of the number of bytes.
/// Guarantees: indices in range, coordinates finite.
std::optional<Mesh> decode_mesh(std::span<const std::byte> bytes, std::size_t vertices, std::size_t faces);

/// The mesh with vertices and faces in the order in which a border that grows over the surface meets them, each face
/// from the corner where it is met: the order that encode_mesh() stores best. Welded; unused vertices and faces that
/// have two corners at one point are left out; nothing else is, and no coordinate changes but that -0 where a 0 lies
/// may become the first of both.
/// \param source_faces  where not null: for each face the given mesh's face it is
/// Same mesh, same bits. Cost: a few linear passes.
Mesh order_for_storage(const Mesh& mesh, std::vector<FaceId>* source_faces = nullptr);

}  // namespace limn::asset
