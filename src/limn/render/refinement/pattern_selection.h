#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "limn/render/refinement/edge_levels.h"
#include "limn/render/refinement/pattern_buffers.h"

namespace limn {

/// What tells shaders of which family the patterns are.
std::string nested_define(PatternFamily family);

/// Chooses every face's pattern on the graphics device and sorts the faces by it: from levels to the commands that draw
/// them, without a word to the CPU (docs/gpu-refinement.md). The unrefined triangles become one index list; the refined
/// faces are sorted by pattern and winding (a counting sort: reduce, scan, scatter), ascending within each.
class PatternSelection {
 public:
  /// Memory on the device: 16 bytes a face, and some hundred bytes a pattern.
  static Result<PatternSelection> create(const RefinementScene& scene, PatternFamily family,
                                         const PatternBuffers& patterns, int max_level);
  ~PatternSelection();
  PatternSelection(PatternSelection&& other) noexcept;
  PatternSelection& operator=(PatternSelection&& other) noexcept;

  /// Submits the work: 7 dispatches, one more for nested patterns, four more for a budget, whatever the scene.
  /// \param levels  of EdgeLevelPass, which kNested patterns write into
  /// \param budget  the most triangles, 0 for as many as the levels ask for: if they are more, one cut is taken from
  /// every level, found to a sixteenth of a sixteenth of the maximal level. Even with all levels 0 there are as many as
  /// the scene has.
  void run(const EdgeLevelPass& levels, std::uint64_t budget) const;

  /// Draws what run() chose: binds index and command buffers and submits one call for the unrefined triangles, two for
  /// the refined ones. \pre the program for each is made current by use_coarse and use_refined
  void draw_coarse() const;
  void draw_refined() const;
  /// One call, over vertices that were stored in the order of the entries. \pre the vertex array feeds a value an
  /// instance
  void draw_stored(const gl::VertexArray& array) const;

  /// One texel: what a budget took from every level.
  const gl::Texture& cut() const;
  /// Waits for the device.
  std::uint64_t triangle_count() const;
  std::size_t bytes() const;

  /// The sorted lists as vertex shaders get them, for tests and for what stores vertices: entries a face | corners <<
  /// 28, 0xffffffff in gaps; and the draw commands of glMultiDrawElementsIndirect, the unrefined triangles' first.
  unsigned entries_buffer() const;
  unsigned commands_buffer() const;
  unsigned lists_buffer() const;
  unsigned frame_buffer() const;
  std::size_t group_count() const;
  std::size_t entry_capacity() const;
  /// Where frame_buffer() has the counts of a dispatch with one invocation an entry.
  static constexpr std::size_t kEntryDispatchOffset = 160;
  /// Where commands_buffer() has, for each group, its first entry, how many, and its first stored vertex: in uints.
  std::size_t first_group_uint() const;

 private:
  struct Impl;
  explicit PatternSelection(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
