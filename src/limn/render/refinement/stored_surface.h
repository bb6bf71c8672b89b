#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "limn/render/refinement/edge_levels.h"
#include "limn/render/refinement/method.h"
#include "limn/render/refinement/pattern_selection.h"

namespace limn {

struct StoredSurfaceOptions {
  PatternFamily family = PatternFamily::kNested;
  Blend blend = Blend::kSurplus;
  bool attributes = true;         ///< normals, texture coordinates, colours, materials too, or positions alone
  std::size_t max_triangles = 0;  ///< room for so many refined triangles
};

/// The refined faces' vertices in the device's memory, computed once by a compute pass for any number of draws that
/// follow, or to be read back (docs/gpu-refinement.md). Each face has its own; what neighbours share has the same bits.
class StoredSurface {
 public:
  /// Memory on the device: 12 bytes a vertex, 24 to 60 with attributes, and room for two vertices a triangle, which no
  /// pattern exceeds. \pre patterns were made with batches
  /// Errors: kNoGraphics when the device cannot hold it.
  static Result<StoredSurface> create(const RefinementScene& scene, const PatternBuffers& patterns,
                                      const PatternSelection& selection, const StoredSurfaceOptions& options);
  /// The most refined triangles that create() has room for on this device, memory apart; needs a current context.
  static std::size_t most_triangles(const RefinementScene& scene, const PatternBuffers& patterns, bool attributes);
  ~StoredSurface();
  StoredSurface(StoredSurface&& other) noexcept;
  StoredSurface& operator=(StoredSurface&& other) noexcept;

  /// Submits the work for what the selection chose: one dispatch. \pre its triangles fit (the selection's budget was at
  /// most max_triangles)
  void run(const EdgeLevelPass& levels, const PatternSelection& selection) const;

  /// Draws the refined faces: one call.
  Result<void> draw(const PatternSelection& selection, const SurfacePass& pass) const;

  std::size_t bytes() const;

  /// The whole surface read back, in world space, one value of each attribute a vertex: unrefined triangles first, then
  /// the refined faces by pattern, each in its pattern's order. Waits for the device. \pre built with attributes
  Mesh read(const PatternSelection& selection) const;

 private:
  struct Impl;
  explicit StoredSurface(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
