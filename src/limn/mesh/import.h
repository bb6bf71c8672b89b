#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// File formats limn reads and writes itself; kOther is whatever else assimp reads, when it was built in.
enum class MeshFormat { kUnknown, kPly, kStl, kOff, kObj, kGltf, kGlb, kOther };

/// The format a file name's extension stands for, in any case; kUnknown without one.
MeshFormat format_of(const std::filesystem::path& path);

/// What people call it: "PLY", "glTF"; "another format" and "an unknown format" for the last two.
std::string_view format_name(MeshFormat format);

struct ImportOptions {
  MeshFormat format = MeshFormat::kUnknown;  ///< kUnknown: told by extension, then by content ("-" has only content)
  Progress progress{};
};

/// A mesh and what its reader had to do to it.
struct ImportedMesh {
  Mesh mesh;
  MeshFormat format = MeshFormat::kUnknown;
  /// One line for each thing in the file that is not in the mesh or was changed: polygons triangulated, points and
  /// lines left out, skins and animations ignored. Empty when the mesh is the file.
  std::vector<std::string> notes;
};

/// Reads a mesh from a file, or from standard input when the path is "-".
///
/// Guarantees on success: every index is in range, every coordinate finite, normals of unit length (those of length 0
/// are replaced by their face's), attribute counts consistent. A file without faces is read; that it has none is for
/// the caller to mind. Memory stays within a small multiple of the file's size whatever its headers claim. Reads no
/// file outside the given file's own folder and those below it, and nothing from a network: a reference to such a file
/// is an error. Errors: kUnreadable (file, place, cause), kUnsuitable for coordinates that are not finite, kCancelled.
Result<ImportedMesh> read_mesh(const std::filesystem::path& path, const ImportOptions& options = {});

/// The same from memory. \param name stands for the file in messages; references to other files are errors.
Result<ImportedMesh> read_mesh(std::span<const std::byte> bytes, MeshFormat format, std::string_view name);

}  // namespace limn
