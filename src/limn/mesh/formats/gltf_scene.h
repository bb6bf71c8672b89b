#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <vector>

#include "limn/mesh/formats/gltf_document.h"

namespace limn::formats::gltf {

/// One appearance of a mesh.
struct Placement {
  std::size_t mesh = 0;
  glm::dmat4 transform{1.0};
};

/// Every appearance of a mesh: those of the default scene; of all scenes when there is no default; all nodes when there
/// is no scene; every mesh once when there is no node. Depth first, children in order. The node of a skinned mesh does
/// not move it (glTF 2.0, section 3.7.3.3): its vertices stay as they are stored. Throws Failure when the nodes do not
/// form trees.
std::vector<Placement> place_meshes(Document& document);

}  // namespace limn::formats::gltf
