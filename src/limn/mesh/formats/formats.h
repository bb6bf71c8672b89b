#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/export.h"
#include "limn/mesh/import.h"
#include "limn/mesh/vertex_mesh.h"

/// One reader and one writer a format; read_mesh() and write_mesh() choose among them and check what comes back.
namespace limn::formats {

/// What a reader is given.
struct Source {
  std::span<const std::byte> bytes;  ///< the whole file
  std::string name;                  ///< for messages
  std::filesystem::path folder;      ///< where relative references resolve; empty: references are refused
  Progress progress{};
};

/// Readers may leave indices unchecked only where they say so; read_mesh() checks every index, count and coordinate
/// after them.
Result<ImportedMesh> read_ply(const Source& source);
Result<ImportedMesh> read_stl(const Source& source);
Result<ImportedMesh> read_off(const Source& source);
Result<ImportedMesh> read_obj(const Source& source);
Result<ImportedMesh> read_gltf(const Source& source);   ///< .gltf and .glb, told apart by content
Result<ImportedMesh> read_other(const Source& source);  ///< through assimp; kUnreadable, saying so, when built without

/// A file and what it should hold; a format may need more than one (OBJ with its MTL).
struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
};

/// The bytes of a mesh in a format. `path` names the main file; the other files lie beside it.
Result<std::vector<OutputFile>> write_ply(const Mesh& mesh, const std::filesystem::path& path, bool ascii);
Result<std::vector<OutputFile>> write_stl(const Mesh& mesh, const std::filesystem::path& path, bool ascii);
Result<std::vector<OutputFile>> write_off(const Mesh& mesh, const std::filesystem::path& path);
Result<std::vector<OutputFile>> write_obj(const Mesh& mesh, const std::filesystem::path& path);

/// What a glTF file holds beside the mesh: an extension of the whole file that readers may do without.
struct GltfExtension {
  std::string name;
  std::vector<std::vector<std::byte>> views;                ///< each becomes a buffer view, one after the other
  std::function<std::string(std::size_t first_view)> json;  ///< its object, given the number of the first of them
};
Result<std::vector<OutputFile>> write_gltf(const Mesh& mesh, const std::filesystem::path& path, bool binary,
                                           const GltfExtension* extension = nullptr);

}  // namespace limn::formats
