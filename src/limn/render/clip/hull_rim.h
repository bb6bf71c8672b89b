#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/mesh/topology.h"
#include "limn/render/camera_block.h"
#include "limn/silhouette/facing.h"

namespace limn {

/// A hull's vertex as the shaders take it, laid out for the device.
struct HullVertex {
  Vec3 position{0};
  Vec3 normal{0};
  Vec2 uv{0};  ///< v upwards
  Vec4 color{1};
  std::uint32_t material = 0;
};
static_assert(sizeof(HullVertex) == 52);

/// Narrow quads along the edges of a coarse hull where it turns away from the viewer.
///
/// The hull encloses the model, but where both share an edge of their outlines the rasterizer, moving vertices to its
/// grid, may find the model's a hair outside. The quads widen the hull's picture by that hair.
class HullRim {
 public:
  HullRim() = default;
  /// \param corners  three a face
  /// \pre planes from face_planes(hull), topology from build_topology(hull); keeps neither
  HullRim(const Topology& topology, std::span<const Plane> planes, std::vector<HullVertex> corners);

  /// How wide, and how the camera stands to the mesh.
  struct View {
    Eye eye{};
    Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< of unit length, in the mesh's space
    float unit_px = 1;  ///< the mesh's units a pixel: at distance 1 (perspective) or anywhere (orthographic)
    float half_width_px = 0.0625f;
    float edge_on = 1e-3f;  ///< planes passing the eye nearer than that times its distance count as both ways
  };

  /// Appends four vertices an edge, in the order of a strip.
  void append(const View& view, std::vector<HullVertex>& quads) const;

 private:
  struct RimEdge {
    std::array<FaceId, 2> faces;
    std::array<std::uint32_t, 2> ends;  ///< in corners_, of the first face
  };
  std::vector<Plane> planes_;
  std::vector<RimEdge> edges_;
  std::vector<HullVertex> corners_;
};

}  // namespace limn
