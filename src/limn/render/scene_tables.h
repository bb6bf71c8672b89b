#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "limn/render/extraction.h"

namespace limn {

/// Not 0, and smaller than the smallest normal float: what a device may take for 0.
inline bool is_subnormal(float value) {
  return std::fpclassify(value) == FP_SUBNORMAL;
}

/// The objects of a scene, one after the other, as SceneExtractor's shaders read them.
struct SceneTables {
  std::vector<FaceId> first_face;  ///< one more than there are objects
  std::vector<EdgeId> first_edge;
  std::vector<std::uint8_t> careful;  ///< an object: whether a normal has subnormal components

  std::vector<Plane> planes;                      ///< a face
  std::vector<std::uint32_t> face_objects;        ///< a face
  std::vector<std::array<EdgeId, 3>> face_edges;  ///< a face, kInvalidId where degenerate; if asked for
  std::vector<std::array<FaceId, 2>> edge_faces;  ///< an edge; the first twice where it has not exactly two
  std::vector<Vec4> edge_middles;  ///< an edge: its midpoint and β, or 0 where it is always 1; if asked for
};

/// \pre as SceneExtractor::create(); fewer than 2^32 faces and edges in all
SceneTables make_scene_tables(std::span<const SceneObject> objects, const SceneExtractorOptions& options);

}  // namespace limn
