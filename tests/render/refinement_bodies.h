#pragma once

#include <gtest/gtest.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "limn/base/random.h"
#include "limn/mesh/shapes.h"
#include "limn/render/refinement/patterns.h"

namespace limn::test {

/// A shape, moved and scaled: x ↦ scale · x + offset.
inline Mesh body(Shape kind, std::size_t faces, float scale = 1.0f, const Vec3& offset = Vec3(0.0f)) {
  auto mesh = make_shape(kind, {.faces = faces});
  EXPECT_TRUE(mesh);
  for (Vec3& p : mesh->positions)
    p = scale * p + offset;
  return std::move(*mesh);
}

inline Refiner refiner_of(Mesh mesh, const PatternMethodOptions& options) {
  RefineOptions refine;
  refine.family = options.family;
  refine.blend = options.blend;
  auto made = Refiner::create(std::move(mesh), refine);
  EXPECT_TRUE(made) << format_error(made.error());
  return std::move(*made);
}

/// The levels that the device decided for an instance.
inline std::vector<float> levels_of(PatternMethod& method, std::size_t instance = 0) {
  std::vector<float> levels;
  for (const std::uint16_t units : method.levels().read(instance))
    levels.push_back(static_cast<float>(units) * kLevelUnit);
  return levels;
}

/// Both families with both blends.
inline std::vector<PatternMethodOptions> families_and_blends() {
  std::vector<PatternMethodOptions> all;
  for (const PatternFamily family : {PatternFamily::kNested, PatternFamily::kMinimal}) {
    for (const Blend blend : {Blend::kSurplus, Blend::kPaper}) {
      PatternMethodOptions options;
      options.family = family;
      options.blend = blend;
      all.push_back(options);
    }
  }
  return all;
}

inline std::string name_of(const PatternMethodOptions& options) {
  return std::string(options.family == PatternFamily::kNested ? "nested" : "minimal") +
         (options.blend == Blend::kSurplus ? ", surplus" : ", paper") + ", level " +
         std::to_string(options.levels.max_level);
}

}  // namespace limn::test
