#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "limn/gl/objects.h"
#include "limn/render/refinement/scene.h"

namespace limn {

/// The levels of all edges of a scene, decided on the graphics device, once an edge: the twin of edge_levels()
/// (refine/levels.h), in units of kLevelUnit. 4 bytes an edge of every instance;
/// for criteria that do not depend on the eye 4 more an edge of every object.
class EdgeLevelPass {
 public:
  /// Errors: those of edge_levels() for the options; kNoGraphics when the device cannot do or hold it.
  /// Shares that do not depend on the eye (curvature, tags) are computed here, from the objects as they are now.
  static Result<EdgeLevelPass> create(const RefinementScene& scene, const LevelOptions& options);
  ~EdgeLevelPass();
  EdgeLevelPass(EdgeLevelPass&& other) noexcept;
  EdgeLevelPass& operator=(EdgeLevelPass&& other) noexcept;

  const LevelOptions& options() const;

  /// Decides the levels for the scene's view: one dispatch and a storage barrier.
  void run() const;

  /// Takes levels the caller chose instead, of all instances' edges in order, without gaps; run() then keeps them.
  /// \pre each in [0, max_level]
  void give(std::span<const float> levels);

  /// The name of the buffer: a uint an edge, at RefinementScene::first_edge(); the level in its lower 16 bits.
  unsigned buffer() const;
  const gl::Texture& texture() const;
  std::size_t bytes() const;

  /// The levels of an instance's edges in units of kLevelUnit; waits for the device.
  std::vector<std::uint16_t> read(std::size_t instance) const;

 private:
  struct Impl;
  explicit EdgeLevelPass(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
