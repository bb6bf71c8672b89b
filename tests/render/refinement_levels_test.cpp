#include <cmath>

#include "limn/mesh/normals.h"

#include "render/drawing_test.h"
#include "render/refinement_bodies.h"
#include "support/stable.h"

namespace limn::test {
namespace {

struct Case {
  Criterion criterion;
  bool orthographic;
  float pixels;
  Wedge::Rule wedge;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Criterion criterion :
       {Criterion::kSilhouette, Criterion::kDistance, Criterion::kCurvature, Criterion::kUniform, Criterion::kTags}) {
    for (const bool orthographic : {false, true}) {
      if (orthographic && criterion == Criterion::kDistance) continue;  // refused, here and there
      for (const float pixels : {0.0f, 0.25f}) {
        all.push_back({criterion, orthographic, pixels, Wedge{}.rule});
        if (criterion == Criterion::kSilhouette)
          all.push_back({criterion, orthographic, pixels, Wedge::Rule::kQuarter});
      }
    }
  }
  return all;
}

/// The eye in some direction, two diagonals from the middle; a picture a thousand pixels high.
View view_of_bounds(const Bounds& bounds, const Vec3& direction, bool orthographic) {
  const float diagonal = static_cast<float>(std::max(bounds.diagonal(), 1e-38));
  if (orthographic) return {{direction, true}, 1000.0f / diagonal};
  return {{bounds.center() + 2.0f * diagonal * direction, false}, 1000.0f};
}

class Levels : public DrawingTest {
 protected:
  void compare(const Refiner& object, const std::string& what) {
    auto scene = RefinementScene::create(*context_, object);
    ASSERT_TRUE(scene) << what;
    const std::vector<Vec3> normals = face_normals(object.mesh());
    Random random(21);
    for (const Case& c : cases()) {
      LevelOptions options;
      options.criterion = c.criterion;
      options.pixels = c.pixels;
      options.wedge.rule = c.wedge;
      options.max_level = 6;
      auto pass = EdgeLevelPass::create(*scene, options);
      ASSERT_TRUE(pass) << format_error(pass.error());
      const View view = view_of_bounds(face_bounds(object.mesh()), random.direction(), c.orthographic);
      scene->set_view(view);
      pass->run();
      const auto expected = edge_levels(object.mesh(), object.topology(), normals, object.curves(), view, options);
      ASSERT_TRUE(expected) << format_error(expected.error());
      const std::vector<std::uint16_t> seen = pass->read(0);
      ASSERT_EQ(seen.size(), expected->size());
      int worst = 0;
      for (std::size_t e = 0; e < seen.size(); ++e) {
        const int off = std::abs(static_cast<int>(seen[e]) - static_cast<int>((*expected)[e] / kLevelUnit));
        worst = std::max(worst, off);
        differ_ += off != 0 ? 1 : 0;
        positive_ += seen[e] > 0 ? 1 : 0;
        ++all_;
      }
      EXPECT_LE(worst, 1) << what << ", criterion " << static_cast<int>(c.criterion) << ", pixels " << c.pixels
                          << (c.orthographic ? ", orthographic" : "");
    }
  }

  void TearDown() override {
    RecordProperty("levels", std::to_string(all_));
    RecordProperty("one_unit_off", std::to_string(differ_));
    EXPECT_LT(static_cast<double>(differ_), 1e-3 * static_cast<double>(all_)) << differ_ << " of " << all_;
    EXPECT_GT(positive_, all_ / 4);
    DrawingTest::TearDown();
  }

  std::size_t differ_ = 0, positive_ = 0, all_ = 0;
};

void add_tags(Mesh& mesh) {
  Random random(22);
  mesh.tags.resize(mesh.positions.size());
  for (float& tag : mesh.tags)
    tag = static_cast<float>(random.uniform(-1.0, 8.0));
}

TEST_F(Levels, OfTheDeviceAreTheCpusForAwkwardMeshes) {
  std::size_t meshes = 0;
  for (const StableMesh& stable : awkward_meshes()) {
    Mesh mesh = stable.mesh;
    add_tags(mesh);
    const auto object = Refiner::create(std::move(mesh));
    if (!object) continue;  // nothing that could be refined
    compare(*object, stable.name);
    ++meshes;
  }
  EXPECT_GE(meshes, 30u);
}

TEST_F(Levels, OfTheDeviceAreTheCpusAtAnyScaleAndPlace) {
  for (const float scale : {1e-30f, 1e-12f, 1e-3f, 1.0f, 1e6f, 1e20f}) {
    for (const float far : {0.0f, 300.0f}) {
      Mesh mesh = body(Shape::kAsteroid, 1280, scale, far * scale * Vec3(1, -2, 0.5f));
      add_tags(mesh);
      compare(refiner_of(std::move(mesh), {}), "scale " + std::to_string(scale) + ", " + std::to_string(far) + " away");
    }
  }
}

}  // namespace
}  // namespace limn::test
