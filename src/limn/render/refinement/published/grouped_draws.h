#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "limn/gl/objects.h"
#include "limn/refine/patterns/table.h"
#include "limn/render/refinement/method.h"
#include "limn/render/refinement/published/pattern_store.h"

namespace limn {

/// Draws a scene's only object a group of faces at a time: all that use one pattern in one winding are the instances of
/// one call (Lenz et al. 2009, section 4.3). Groups are arranged on the CPU and uploaded.
class GroupedDraws {
 public:
  /// What a face asks for. group: 2 · pattern + 1 where mirrored; detail: what refine_grouped.vert.glsl wants to know.
  struct Choice {
    static constexpr std::uint32_t kNotDrawn = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t group = kNotDrawn;
    std::uint32_t detail = 0;
  };
  /// Where a group's faces lie in the sorted list.
  struct Group {
    std::uint32_t group = 0, first = 0, count = 0;
  };

  /// Memory on the device: 8 bytes a face and the patterns. \param defines  of refine_grouped.vert.glsl. Errors:
  /// kNoGraphics when the device cannot hold them. \pre the scene has one instance and outlives this
  static Result<GroupedDraws> create(const RefinementScene& scene, const PatternTable& table,
                                     std::vector<std::string> defines);

  /// Sorts the faces by group, ascending within each, and uploads them: 8 bytes a face.
  /// \param choices  one a face
  void arrange(std::span<const Choice> choices);

  /// One call a group that has faces.
  Result<void> draw(const SurfacePass& pass);

  const std::vector<Group>& groups() const { return groups_; }
  const PatternStore& patterns() const { return patterns_; }
  std::uint64_t triangle_count() const;
  std::size_t bytes() const;

 private:
  GroupedDraws(const RefinementScene& scene, std::vector<std::string> defines)
      : scene_(&scene), programs_({.vertex = "refine_grouped.vert.glsl", .defines = std::move(defines)}) {}
  void draw_groups() const;
  const RefinementScene* scene_;
  SurfacePrograms programs_;
  PatternStore patterns_;
  gl::VertexArray array_;
  gl::Buffer entries_;
  std::vector<Group> groups_;
};

}  // namespace limn
