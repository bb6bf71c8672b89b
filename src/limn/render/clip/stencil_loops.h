#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/aligned.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/eye.h"
#include "limn/silhouette/facing.h"

namespace limn {

/// Triangles whose signed areas in any picture add up to the silhouette's winding numbers: what the stencil counts.
struct StencilLoops {
  LineVector<Vec3> points;            ///< loop after loop, each point where an edge of the silhouette starts
  LineVector<std::uint32_t> corners;  ///< indices into points, three a triangle
  LineVector<std::uint32_t> ends;     ///< a loop: one past its last point
  std::size_t edge_count = 0;         ///< edges of the silhouette

  std::size_t triangle_count() const { return corners.size() / 3; }
};

/// Strings a closed mesh's silhouette into loops and cuts these into triangles (Sander et al. 2000, section 6).
///
/// Loops are followed through a table by vertex, without sorting or hashing; where loops meet at a vertex any of the
/// edges that leave it is taken, which changes no winding number. A loop of n edges becomes n - 2 triangles by cutting
/// off every second vertex, again and again: most triangles are as small as two edges, few are large, which is what
/// the paper's splitting of loops aims at.
class StencilLoopBuilder {
 public:
  StencilLoopBuilder() = default;

  /// Keeps nothing of its arguments.
  /// \pre closed: every edge's faces run along it as often one way as the other (is_closed); planes from
  /// face_planes(mesh)
  StencilLoopBuilder(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes);

  /// \param edges  the silhouette edges that have two faces, each once, as SilhouetteExtractor::find gives them;
  ///               edges of more faces are looked at here
  /// \param loops  overwritten. Same result for any number of threads.
  /// Cost: linear in the silhouette's edges; allocates only while `loops` grows. One call at a time.
  void build(std::span<const EdgeId> edges, const Eye& eye, StencilLoops& loops);

  std::size_t memory_bytes() const;

 private:
  struct DirectedEdge {
    VertexId from, to;  ///< as its face `left` runs
    Plane left;
  };
  /// A face at an edge that has more than two.
  struct CrowdedFace {
    VertexId from, to;  ///< as the face runs
    FaceId face;
    Plane plane;
  };
  struct Step {
    VertexId from, to;
    std::uint32_t next;  ///< of the steps that leave `from`, the one to take after this
  };

  void add_step(VertexId from, VertexId to);
  void add_crowded(const Eye& eye);
  void follow(StencilLoops& loops);

  std::vector<Vec3> positions_;
  LineVector<DirectedEdge> edges_;
  std::vector<CrowdedFace> crowded_;   ///< those of an edge in a row
  LineVector<std::uint32_t> leaving_;  ///< a vertex: its first step, kInvalidId between calls
  LineVector<Step> steps_;
  std::size_t step_count_ = 0;
};

/// Whether the faces at every edge run along it as often one way as the other, so that its silhouette is made of loops
/// from wherever it is seen.
bool is_closed(const Topology& topology);

/// Appends the triangles of a loop of points first … first + count - 1.
void append_loop_triangles(std::uint32_t first, std::uint32_t count, LineVector<std::uint32_t>& corners);

}  // namespace limn
