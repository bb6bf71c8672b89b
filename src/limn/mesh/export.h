#pragma once

#include <filesystem>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/mesh/import.h"
#include "limn/mesh/mesh.h"

namespace limn {

struct ExportOptions {
  MeshFormat format = MeshFormat::kUnknown;  ///< kUnknown: told by extension; "-" needs it
  bool ascii = false;                        ///< PLY and STL: text instead of little-endian binary
  Progress progress{};
};

/// Writes a mesh whole or not at all; "-" is standard output.
///
/// Positions keep their bits in every format (text is written with the shortest digits that read back the same).
/// OBJ keeps attributes by corner; PLY and glTF hold one value a vertex, so a vertex is repeated, bit for bit, where
/// its corners differ; STL and OFF hold positions only. glTF and OBJ carry materials (OBJ beside it as NAME.mtl). Same
/// mesh, same bytes. Errors: kUnwritable, kInvalidArgument for an unknown format or one that is read only.
Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path, const ExportOptions& options = {});

}  // namespace limn
