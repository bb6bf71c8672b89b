#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limn/asset/clip_asset.h"
#include "limn/gl/context.h"
#include "limn/render/clip/edge_on.h"
#include "limn/render/clip/eye_place.h"
#include "limn/render/clip/hull_rim.h"
#include "limn/render/clip/interior_pass.h"
#include "limn/render/clip/stencil_loops.h"
#include "limn/render/materials.h"
#include "limn/silhouette/extractor.h"

namespace limn {

/// One silhouette of a clip asset, ready to be searched and drawn.
struct ClipLevel {
  std::vector<Plane> planes;
  SilhouetteExtractor extractor;  ///< keeps `planes`
  StencilLoopBuilder loops;
  EdgeOnFaces edge_on;
  float error = 0;              ///< in the model's units, scaled as the model is
  gl::Buffer positions, faces;  ///< all of the mesh, for when the silhouette does not tell what is covered
  gl::VertexArray array;
  std::size_t face_count = 0;
};

/// The original with smooth normals, for eyes too close for a hull.
struct ClipOriginal {
  gl::Buffer vertices;
  gl::VertexArray array;
  std::size_t vertex_count = 0;
};

/// A clip asset in the device's memory, with what finds its silhouettes (docs/clipping.md). Draw it with a ClipFrame.
class ClipModel {
 public:
  /// Everything is scaled by a power of two to near unit size, as render() does, so that pixels come out the same.
  /// Needs a current context. Cost: a search structure a level (about 1 µs an edge), uploads.
  /// Errors: kUnsuitable where the hull or a level has no faces or is not closed, or a material's picture cannot be
  /// decoded; kNoGraphics when the device cannot hold it.
  static Result<ClipModel> create(gl::Context& context, const ClipAsset& asset);

  std::size_t level_count() const { return levels_.size(); }
  /// By what the model's units were multiplied: 1, or a power of two for very small or large models.
  double unit_scale() const { return unit_scale_; }
  const Bounds& bounds() const { return bounds_; }  ///< of the original, scaled
  std::size_t memory_bytes() const;                 ///< on the host, of the search structures

 private:
  friend class ClipFrame;
  ClipModel() = default;
  Result<void> add_level(const SilhouetteLevel& level);
  Result<void> add_hull(const ClipAsset& asset);
  void add_maps(const DetailMaps& maps);
  void add_shell(const Mesh& hull, const std::vector<HullVertex>& corners);

  const ClipOriginal& original();

  double unit_scale_ = 1;
  Bounds bounds_;
  std::vector<std::unique_ptr<ClipLevel>> levels_;
  gl::Buffer hull_vertices_, hull_indices_, rim_indices_;
  gl::VertexArray hull_array_, rim_array_, loop_array_;
  std::size_t hull_index_count_ = 0;
  HullRim rim_;
  EyeLocator locator_;
  std::unique_ptr<MaterialTable> materials_, plain_material_;
  gl::Texture normals_, colors_, displacement_;
  float displacement_low_ = 0, displacement_high_ = 0;
  ShellBuffers shell_;  ///< where there are object-space normals and a displacement
  Mesh original_mesh_;  ///< of the finest level
  std::optional<ClipOriginal> original_;
};

}  // namespace limn
