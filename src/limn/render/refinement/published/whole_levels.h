#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/mesh/topology.h"
#include "limn/refine/levels.h"
#include "limn/render/refinement/scene.h"

namespace limn {

/// The levels of a scene's only object, decided on the CPU and rounded up to whole halvings, as the methods before Lenz
/// et al. 2009 and theirs take them.
class WholeLevels {
 public:
  /// \pre the scene has one instance and outlives this. Errors: those of edge_levels() for the options.
  static Result<WholeLevels> create(const RefinementScene& scene, const LevelOptions& options);

  /// edge_levels() as seen from the view, unless levels were given. Errors: those of edge_levels().
  Result<void> decide(const View& view);

  /// Takes levels the caller chose from now on. \pre one an edge, each in [0, max_level]
  void give(std::span<const float> levels);

  const Topology& topology() const { return object_->topology(); }
  const LevelOptions& options() const { return options_; }

  /// Whether the face is drawn: degenerate ones are not.
  bool draws(FaceId face) const { return topology().face_edges[face][0] != kInvalidId; }
  /// log2 of the segments of a face's sides. \pre draws(face)
  std::array<std::uint8_t, 3> sides(FaceId face) const;

 private:
  void round_up(std::span<const float> levels);
  const Refiner* object_ = nullptr;
  LevelOptions options_;
  std::vector<Vec3> face_normals_;
  std::vector<std::uint8_t> edges_;
  bool given_ = false;
};

}  // namespace limn
