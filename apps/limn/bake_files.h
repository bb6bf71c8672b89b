#pragma once

#include <string>
#include <vector>

#include "limn/bake/bake.h"

#include "session.h"

namespace limn::cli {

/// How `bake` stores its maps.
struct BakeFileOptions {
  std::string path;  ///< a model that carries materials (.glb, .gltf, .obj), or a folder
  int depth = 8;     ///< bits a channel: 8, 16, or 32 for OpenEXR
};

/// Whether the output is a model that carries its maps; else it is a folder.
bool is_model(const std::string& path);

/// Writes the model, or into the folder a picture a map, mesh.glb and maps.json with what the pictures' values mean.
/// The folder is made when it is not there. Gives the files' names. Errors: kUnwritable.
Result<std::vector<std::string>> write_maps(Session& session, const BakedMaps& maps, const BakeFileOptions& options);

}  // namespace limn::cli
