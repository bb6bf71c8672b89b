#include <algorithm>
#include <glm/geometric.hpp>

#include "limn/render/camera_block.h"
#include "limn/render/materials.h"
#include "limn/render/targets.h"

#include "render/drawing_test.h"
#include "render/refinement_bodies.h"

namespace limn::test {
namespace {

constexpr int kSide = 96;

/// Which pixels a surface covers, with a border of background around.
class Coverage {
 public:
  explicit Coverage(const Image& image) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x)
        covered_[at(x, y)] = image.pixel(x, y)[3] > 0;
    }
  }

  std::size_t pixels() const { return static_cast<std::size_t>(std::count(covered_.begin(), covered_.end(), true)); }

  /// Background that no path of background pixels, side by side, joins with the outside.
  std::size_t enclosed() const {
    std::vector<bool> reached(covered_.size());
    std::vector<std::size_t> open = {0};
    reached[0] = true;
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      for (const std::size_t step : {std::size_t{1}, kRow, covered_.size() - 1, covered_.size() - kRow}) {
        const std::size_t to = (from + step) % covered_.size();  // around the border there is only border
        if (reached[to] || covered_[to]) continue;
        reached[to] = true;
        open.push_back(to);
      }
    }
    return covered_.size() - pixels() - static_cast<std::size_t>(std::count(reached.begin(), reached.end(), true));
  }

  /// Background where another picture is covered, and all around too: not a matter of where the outline falls.
  std::size_t holes_in(const Coverage& whole) const {
    std::size_t count = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x)
        count += !covered_[at(x, y)] && whole.covered_around(x, y) ? 1 : 0;
    }
    return count;
  }

 private:
  static constexpr std::size_t kRow = kSide + 2;
  static std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y + 1) * kRow + static_cast<std::size_t>(x + 1);
  }
  bool covered_around(int x, int y) const {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!covered_[at(x + dx, y + dy)]) return false;
      }
    }
    return true;
  }

  std::vector<bool> covered_ = std::vector<bool>(kRow * kRow);
};

struct Body {
  const char* what;
  Mesh mesh;
  bool convex;  // nothing of the background shows through
};

std::vector<Body> bodies() {
  return {{"cube with hard edges", body(Shape::kCube, 108), true},
          {"sphere with a seam", body(Shape::kIcosphere, 180), true},
          {"open sheet", body(Shape::kSheet, 72), false},
          {"knot", body(Shape::kKnot, 300), false},
          {"asteroid", body(Shape::kAsteroid, 180), false}};
}

Camera random_camera(const Mesh& mesh, Random& random) {
  CameraFit fit;
  fit.orthographic = random.below(4) == 0;
  fit.fill = static_cast<float>(random.uniform(0.5, 2.5));
  return fit_camera(face_bounds(mesh), random.direction(), fit);
}

class Views : public DrawingTest {
 protected:
  Coverage seen(const Mesh& mesh, const Camera& camera) {
    return Coverage(draw(mesh, camera, picture_options(kSide, kSide, 1, kTransparent)));
  }

  void look(const Body& b, const PatternMethodOptions& options, int views, Random& random) {
    const Refiner object = refiner_of(b.mesh, options);
    auto scene = RefinementScene::create(*context_, object);
    ASSERT_TRUE(scene);
    auto method = PatternMethod::create(*scene, options);
    ASSERT_TRUE(method) << format_error(method.error());
    const auto targets = RenderTargets::create(kSide, kSide, 1);
    const auto materials = MaterialTable::create(object.mesh());
    const CameraBuffer block;
    ASSERT_TRUE(targets && materials);
    for (int view = 0; view < views; ++view, ++views_) {
      const Camera camera = random_camera(b.mesh, random);
      ASSERT_TRUE(method->refine(view_of(camera, kSide)));
      targets->begin_faces();
      materials->bind();
      block.update(make_camera_block(camera, kSide, kSide));
      block.bind();
      ASSERT_TRUE(method->draw({}));
      const auto picture = targets->resolve(*context_, kTransparent);
      ASSERT_TRUE(picture);
      const Coverage coverage(*picture);
      const auto reference = object.refine_with(levels_of(*method));
      ASSERT_TRUE(reference);
      EXPECT_EQ(coverage.holes_in(seen(reference->mesh, camera)), 0u) << b.what << ", " << name_of(options);
      if (b.convex) {
        EXPECT_EQ(coverage.enclosed(), 0u) << b.what << ", " << name_of(options);
      }
      covered_ += coverage.pixels();
    }
  }

  std::size_t views_ = 0, covered_ = 0;
};

TEST_F(Views, AThousandShowNoBackgroundInsideARefinedSurface) {
  Random random(11);
  for (PatternMethodOptions options : families_and_blends()) {
    for (const Body& b : bodies()) {
      for (int level = 1; level <= 5; ++level) {
        options.levels.max_level = level;
        options.store = level == 3;
        look(b, options, 10, random);
      }
    }
  }
  EXPECT_EQ(views_, 1000u);
  EXPECT_GT(covered_, views_ * kSide * kSide / 4);
}

/// Every triangle on its own, smaller by a share: gaps wherever two met.
Mesh torn(const Mesh& mesh, float share) {
  Mesh result;
  for (const Triangle& face : mesh.faces) {
    const Vec3 middle = (mesh.positions[face[0]] + mesh.positions[face[1]] + mesh.positions[face[2]]) / 3.0f;
    const auto first = static_cast<VertexId>(result.positions.size());
    for (const VertexId v : face)
      result.positions.push_back(mesh.positions[v] + share * (middle - mesh.positions[v]));
    result.faces.push_back({first, first + 1, first + 2});
  }
  return result;
}

TEST_F(Views, ShowTheGapsOfATornSurface) {
  const Mesh sphere = body(Shape::kIcosphere, 180);
  Random random(12);
  std::size_t holes = 0, enclosed = 0, whole_enclosed = 0;
  for (int view = 0; view < 20; ++view) {
    const Camera camera = random_camera(sphere, random);
    // The far side shows through gaps of the near side: it is left out.
    Mesh near = sphere;
    std::erase_if(near.faces, [&](const Triangle& face) {
      const Vec3 middle = near.positions[face[0]] + near.positions[face[1]] + near.positions[face[2]];
      return glm::dot(middle, camera.eye - camera.target) < 0.0f;
    });
    const Coverage gaps = seen(torn(near, 0.005f), camera);
    const Coverage whole = seen(near, camera);
    holes += gaps.holes_in(whole);
    enclosed += gaps.enclosed();
    whole_enclosed += whole.enclosed();
  }
  EXPECT_GT(holes, 20u);
  EXPECT_GT(enclosed, 20u);
  EXPECT_EQ(whole_enclosed, 0u);
}

}  // namespace
}  // namespace limn::test
