#pragma once

#include <vector>

#include "limn/mesh/formats/gltf_document.h"
#include "limn/mesh/mesh.h"

namespace limn::formats::gltf {

/// All materials of the document in its order. Throws Failure on malformed ones; textures that cannot be used become
/// notes.
std::vector<Material> read_materials(Document& document);

/// The material of primitives that name none (glTF 2.0, section 3.9.6).
Material default_material();

}  // namespace limn::formats::gltf
