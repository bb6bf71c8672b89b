#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/render/refinement/patterns.h"

#include "render/capture.h"
#include "render/drawing_test.h"

namespace limn::test {
namespace {

class Refinement : public DrawingTest {
 protected:
  Refiner refiner(Mesh mesh, PatternFamily family, Blend blend = Blend::kSurplus) {
    RefineOptions options;
    options.family = family;
    options.blend = blend;
    auto made = Refiner::create(std::move(mesh), options);
    EXPECT_TRUE(made) << format_error(made.error());
    return std::move(*made);
  }
};

Mesh shape(Shape kind, std::size_t faces) {
  auto mesh = make_shape(kind, {.faces = faces});
  EXPECT_TRUE(mesh);
  return std::move(*mesh);
}

/// The CPU's triangles of the levels that the device found, face by face, must be the device's.
void expect_same_triangles(const Refiner& refiner, PatternMethod& method, PatternFamily family) {
  const std::vector<std::uint16_t> units = method.levels().read(0);
  std::vector<float> levels(units.size());
  std::transform(units.begin(), units.end(), levels.begin(),
                 [](std::uint16_t u) { return static_cast<float>(u) * kLevelUnit; });
  const auto expected = refiner.refine_with(levels);
  ASSERT_TRUE(expected) << format_error(expected.error());
  const Mesh& mesh = expected->mesh;
  const std::vector<CapturedVertex> seen = capture(method, 3 * mesh.faces.size() + 30000);
  ASSERT_EQ(seen.size(), 3 * mesh.faces.size());
  EXPECT_EQ(method.triangle_count(), mesh.faces.size());

  std::map<FaceId, std::vector<std::size_t>>
      by_face;  // the CPU's triangles of each refined face; kInvalidId: of the rest
  std::vector<std::size_t> count(refiner.mesh().face_count(), 0);
  for (const FaceId f : expected->source_face)
    ++count[f];
  for (std::size_t t = 0; t < mesh.faces.size(); ++t) {
    const FaceId f = expected->source_face[t];
    by_face[count[f] == 1 ? kInvalidId : f].push_back(t);
  }
  std::map<FaceId, std::size_t> next;
  const double scale = face_bounds(refiner.mesh()).diagonal();
  double worst = 0.0;
  for (std::size_t i = 0; i < seen.size(); i += 3) {
    const auto& known = by_face[seen[i].face];
    const std::size_t at = next[seen[i].face]++;
    ASSERT_LT(at, known.size()) << "face " << seen[i].face << " family " << static_cast<int>(family);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 p = mesh.positions[mesh.faces[known[at]][c]];
      worst = std::max(worst, glm::length(DVec3(p) - DVec3(seen[i + c].position)) / scale);
    }
  }
  EXPECT_LT(worst, 2e-7) << "of the diagonal";
}

TEST_F(Refinement, DrawsTheTrianglesOfTheCpu) {
  for (const PatternFamily family : {PatternFamily::kNested, PatternFamily::kMinimal}) {
    for (const Blend blend : {Blend::kSurplus, Blend::kPaper}) {
      for (const Shape kind : {Shape::kKnot, Shape::kAsteroid, Shape::kHoles3}) {
        const Refiner object = refiner(shape(kind, 600), family, blend);
        auto scene = RefinementScene::create(*context_, object);
        ASSERT_TRUE(scene) << format_error(scene.error());
        PatternMethodOptions options;
        options.family = family;
        options.blend = blend;
        options.levels.max_level = 4;
        auto method = PatternMethod::create(*scene, options);
        ASSERT_TRUE(method) << format_error(method.error());
        const View view{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};
        ASSERT_TRUE(method->refine(view));
        expect_same_triangles(object, *method, family);
      }
    }
  }
}

TEST_F(Refinement, FindsTheLevelsOfTheCpu) {
  const Refiner object = refiner(shape(Shape::kKnot, 5000), PatternFamily::kNested);
  auto scene = RefinementScene::create(*context_, object);
  ASSERT_TRUE(scene);
  std::size_t differ = 0, all = 0;
  for (const Criterion criterion :
       {Criterion::kSilhouette, Criterion::kDistance, Criterion::kCurvature, Criterion::kUniform}) {
    for (const float pixels : {0.0f, 0.3f}) {
      LevelOptions options;
      options.criterion = criterion;
      options.pixels = pixels;
      options.max_level = 5;
      auto pass = EdgeLevelPass::create(*scene, options);
      ASSERT_TRUE(pass) << format_error(pass.error());
      const View view{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};
      scene->set_view(view);
      pass->run();
      const auto expected =
          edge_levels(object.mesh(), object.topology(), face_normals(object.mesh()), object.curves(), view, options);
      ASSERT_TRUE(expected);
      const std::vector<std::uint16_t> seen = pass->read(0);
      for (std::size_t e = 0; e < seen.size(); ++e) {
        const int off = static_cast<int>(seen[e]) - static_cast<int>((*expected)[e] / kLevelUnit);
        ASSERT_LE(std::abs(off), 1) << e << " criterion " << static_cast<int>(criterion) << " pixels " << pixels;
        differ += off != 0 ? 1 : 0;
        ++all;
      }
    }
  }
  EXPECT_LT(static_cast<double>(differ), 1e-3 * static_cast<double>(all)) << differ;
}

/// Each triangle of one has its own in the other, corner by corner, within a tolerance; whatever their order.
void expect_same_surface(const Mesh& a, const Mesh& b, double tolerance) {
  ASSERT_EQ(a.faces.size(), b.faces.size());
  using Corners = std::array<Vec3, 3>;
  const auto sorted = [](const Mesh& mesh) {
    std::vector<Corners> all;
    for (const Triangle& t : mesh.faces)
      all.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    std::sort(all.begin(), all.end(), [](const Corners& l, const Corners& r) { return l[0].x < r[0].x; });
    return all;
  };
  const std::vector<Corners> left = sorted(a), right = sorted(b);
  const auto near = [tolerance](const Corners& l, const Corners& r) {
    return std::equal(l.begin(), l.end(), r.begin(), [tolerance](const Vec3& p, const Vec3& q) {
      return glm::length(DVec3(p) - DVec3(q)) <= tolerance;
    });
  };
  std::vector<bool> taken(right.size(), false);
  std::size_t low = 0;
  for (const Corners& corners : left) {
    while (low < right.size() && double{right[low][0].x} < double{corners[0].x} - tolerance)
      ++low;
    std::size_t at = low;
    while (at < right.size() && double{right[at][0].x} <= double{corners[0].x} + tolerance &&
           (taken[at] || !near(corners, right[at])))
      ++at;
    ASSERT_TRUE(at < right.size() && near(corners, right[at])) << "a triangle of one is not in the other";
    taken[at] = true;
  }
}

TEST_F(Refinement, StoresWhatItDraws) {
  for (const PatternFamily family : {PatternFamily::kNested, PatternFamily::kMinimal}) {
    for (const Shape kind : {Shape::kKnot, Shape::kAsteroid}) {
      const Refiner object = refiner(shape(kind, 2000), family);
      auto scene = RefinementScene::create(*context_, object);
      ASSERT_TRUE(scene);
      PatternMethodOptions options;
      options.family = family;
      options.store = true;
      auto method = PatternMethod::create(*scene, options);
      ASSERT_TRUE(method) << format_error(method.error());
      const View view{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};
      ASSERT_TRUE(method->refine(view));
      const Result<Mesh> stored = method->read();
      ASSERT_TRUE(stored);
      const std::vector<std::uint16_t> units = method->levels().read(0);
      std::vector<float> levels(units.size());
      std::transform(units.begin(), units.end(), levels.begin(),
                     [](std::uint16_t u) { return static_cast<float>(u) * kLevelUnit; });
      const auto expected = object.refine_with(levels);
      ASSERT_TRUE(expected);
      expect_same_surface(*stored, expected->mesh, 1e-6 * face_bounds(object.mesh()).diagonal());
      // Closed, welded by exact position: neighbours have the same bits.
      const Topology topology = build_topology(*stored);
      for (const EdgeClass edge : topology.edge_class)
        ASSERT_EQ(edge, EdgeClass::kManifold);
      EXPECT_TRUE(topology.degenerate_faces.empty());
    }
  }
}

}  // namespace
}  // namespace limn::test
