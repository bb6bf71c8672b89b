#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "limn/refine/levels.h"
#include "limn/render/refinement/method.h"

namespace limn {

struct GroupedMethod;

/// Lenz, Cavalcante-Neto and Vidal 2009 as published (docs/lenz-patterns.md): only patterns with i ≥ j ≥ k are stored,
/// C(N+2, 3) of the N³ that N levels allow; λ turns them; the CPU decides the levels, selects patterns and arranges the
/// faces in groups by base pattern, and one instanced call draws a group. The mesh lies on the device.
///
/// Levels are whole, those of edge_levels() rounded up, nothing is blended, every vertex is on its patch. limn's one
/// correction: permutations that mirror a pattern have groups and index lists of their own, without which their
/// triangles show their backs.
///
/// A frame: an upload of 8 bytes a face in refine(), a call for each group that has faces in draw(), at most
/// 2·C(N+2, 3). Watertight bit for bit: edges are evaluated by themselves.
class ArkfpiMethod final : public RefinementMethod {
 public:
  /// A group of faces that one call draws.
  struct Group {
    std::uint32_t base = 0;  ///< the pattern (refine/patterns/pattern.h, kMinimal)
    bool mirrored = false;
    std::uint32_t faces = 0;
  };

  /// \pre the scene has one instance, does not deform, outlives this and stays where it is
  /// Errors: kNoGraphics; those of edge_levels() for the options.
  static Result<ArkfpiMethod> create(RefinementScene& scene, const LevelOptions& levels = {});
  ~ArkfpiMethod() override;
  ArkfpiMethod(ArkfpiMethod&& other) noexcept;
  ArkfpiMethod& operator=(ArkfpiMethod&& other) noexcept;

  /// Levels the caller chose, from now on. \pre one an edge, each in [0, max_level]
  void give_levels(std::span<const float> levels);

  /// Errors: those of edge_levels() for the view.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  std::uint64_t triangle_count() const override;
  std::size_t device_bytes() const override;

  /// What refine() arranged, ascending by base.
  std::vector<Group> groups() const;
  std::size_t stored_patterns() const;
  std::size_t pattern_bytes() const;

 private:
  explicit ArkfpiMethod(std::unique_ptr<GroupedMethod> impl);
  std::unique_ptr<GroupedMethod> impl_;
};

}  // namespace limn
