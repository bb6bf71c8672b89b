#include "limn/hull/strict_guard.h"

#include <gtest/gtest.h>

#include "limn/hull/progressive_hull.h"
#include "limn/hull/self_intersections.h"
#include "limn/hull/sequence.h"
#include "limn/mesh/shapes.h"

namespace limn::test {
namespace {

std::size_t count_pairs(const Mesh& mesh) {
  return self_intersections(mesh.positions, mesh.faces).size();
}

/// Every member of the hull's sequence, some steps apart.
std::size_t pairs_on_the_way(const Hull& hull, bool inwards) {
  const Result<HullSequence> sequence = HullSequence::make(hull.shell, inwards ? std::vector<HullStep>{} : hull.steps,
                                                           inwards ? hull.steps : std::vector<HullStep>{});
  EXPECT_TRUE(sequence);
  if (!sequence) return 1;
  std::size_t pairs = 0;
  for (int steps = 0; steps <= sequence->outermost() - sequence->innermost(); steps += 37)
    pairs += count_pairs(sequence->mesh_at(inwards ? -steps : steps));
  return pairs;
}

TEST(StrictGuard, LetsNoHullCrossItself) {
  std::size_t loose = 0;
  for (const Shape shape : {Shape::kKnot, Shape::kHoles3, Shape::kAsteroid}) {
    const Mesh mesh = *make_shape(shape, {.faces = 2000});
    for (const HullSide side : {HullSide::kOuter, HullSide::kInner}) {
      for (const std::size_t faces : {200u, 40u}) {
        HullOptions options;
        options.faces = faces;
        options.side = side;
        options.keep_steps = true;
        const Result<Hull> without = build_hull(mesh, options);
        options.strict = true;
        const Result<Hull> with = build_hull(mesh, options);
        ASSERT_TRUE(with && without);
        loose += count_pairs(without->mesh);
        EXPECT_EQ(count_pairs(with->mesh), 0u);
        EXPECT_EQ(pairs_on_the_way(*with, side == HullSide::kInner), 0u);
        EXPECT_LT(with->mesh.faces.size(), mesh.faces.size() / 2);
      }
    }
  }
  EXPECT_GT(loose, 10u);
}

}  // namespace
}  // namespace limn::test
