#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/context.h"
#include "limn/refine/refine.h"
#include "limn/silhouette/eye.h"

namespace limn {

/// An object of a scene put somewhere.
struct RefinementInstance {
  std::size_t object = 0;
  Mat4 to_world{1.0f};  ///< affine; a rotation, a translation and one factor of scale
};

/// A vertex of a scene read back; what the scene lacks keeps these values.
struct SceneVertex {
  Vec3 position{0.0f}, normal{0.0f};
  Vec2 uv{0.0f};
  Vec4 color{1.0f};
  std::uint32_t material = 0;
};

struct RefinementSceneOptions {
  /// Positions and normals live on the device and change there: update_surface() makes face normals and curves anew.
  bool deforming = false;
  CenterRule center = CenterRule::kPn;
};

/// Meshes on the graphics device with what refining them needs: vertices, faces, their edges, face normals and edge
/// curves, and where each instance stands and is seen from. The tables of docs/gpu-refinement.md; no algorithm.
///
/// Vertices are split where attributes differ at a corner (a seam), so that each has one value of each.
/// Work on the device counts faces and edges over all instances: those of instance i begin at first_face(i) and
/// first_edge(i), both multiples of 256, so that a workgroup serves one instance. Belongs to the context's thread and
/// must not outlive the context.
class RefinementScene {
 public:
  /// Uploads everything. Memory on the device, in bytes, beyond the vertices and the faces' vertex ids: 24 an edge
  /// (curves) and 8 (its faces), 12 a face (edges) and 12 (normals).
  /// \pre objects are not null, each instance names one of them, there is at least one of each; matrices can be
  /// inverted
  /// Errors: kNoGraphics when the device cannot hold it.
  static Result<RefinementScene> create(gl::Context& context, std::span<const Refiner* const> objects,
                                        std::span<const RefinementInstance> instances,
                                        const RefinementSceneOptions& options = {});
  /// One object where it is.
  static Result<RefinementScene> create(gl::Context& context, const Refiner& object,
                                        const RefinementSceneOptions& options = {});
  ~RefinementScene();
  RefinementScene(RefinementScene&& other) noexcept;
  RefinementScene& operator=(RefinementScene&& other) noexcept;

  std::size_t instance_count() const;
  /// Faces and edges of all instances, gaps before the next multiple of 256 included; what per-face and per-edge
  /// buffers must hold.
  std::size_t face_capacity() const;
  std::size_t edge_capacity() const;
  std::size_t first_face(std::size_t instance) const;
  std::size_t first_edge(std::size_t instance) const;
  /// Faces of all instances, without gaps.
  std::size_t triangle_count() const;
  const RefinementSceneOptions& options() const;
  const Refiner& object_of(std::size_t instance) const;  ///< \pre it still lives
  std::vector<const Refiner*> objects() const;
  gl::Context& context() const;

  /// Bytes of device memory, the meshes themselves (vertices, their attributes, faces' vertex ids) apart.
  std::size_t mesh_bytes() const;
  std::size_t table_bytes() const;

  /// Sets from where the scene is seen, in world space, each instance in its own space: one upload of 112 bytes an
  /// instance. Which levels follow from it is up to refine(); what was refined stays until then.
  void set_view(const View& view);
  /// Moves an instance; takes part from the next set_view().
  void set_transform(std::size_t instance, const Mat4& to_world);

  /// For deforming objects: buffers of three floats a vertex for an application to write on the device. Vertices of
  /// object o begin at first_vertex(o); vertex v of it repeats position vertex_source(o)[v] of its mesh, and repeats
  /// must stay equal. \pre deforming
  unsigned positions_buffer() const;
  unsigned normals_buffer() const;
  std::size_t first_vertex(std::size_t object) const;
  const std::vector<VertexId>& vertex_source(std::size_t object) const;
  /// Makes face normals and curves from the buffers above, in double, as face_normals() and edge_curves() do. Two
  /// dispatches. \pre deforming
  void update_surface();

  /// Binds the tables of refine_scene.glsl, texture units 0 to 10; those of refine_edge_tables.glsl, units 11 to 13.
  void bind() const;
  void bind_edge_tables() const;

  bool has_uvs() const;
  bool has_colors() const;
  /// Whether vertices name materials of their own; if not, all have material 0.
  bool has_materials() const;
  /// The objects' meshes, as MaterialTable::create() wants them: vertices name materials in that order.
  const std::vector<const Mesh*>& meshes() const;
  /// Vertices of all instances, gaps included: what the values of an index buffer over the scene mean (the vertex stage
  /// finds instance and vertex from them).
  std::size_t vertex_capacity() const;
  /// These vertices in world space, as they are on the device now; waits for it. Gaps hold anything.
  std::vector<SceneVertex> read_vertices() const;

 private:
  struct Impl;
  explicit RefinementScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
