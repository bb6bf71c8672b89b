#include "limn/render/refinement/static_mesh.h"

#include <algorithm>
#include <array>

#include "limn/mesh/shapes.h"

#include "render/capture.h"
#include "render/drawing_test.h"

namespace limn::test {
namespace {

constexpr View kView{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};

class StaticMesh : public DrawingTest {
 protected:
  Refiner refiner(Mesh mesh) {
    auto made = Refiner::create(std::move(mesh));
    EXPECT_TRUE(made) << format_error(made.error());
    return std::move(*made);
  }
};

TEST_F(StaticMesh, DrawsTheUniformlyRefinedMeshOfTheCpu) {
  const Refiner object = refiner(make_shape(Shape::kKnot, {.faces = 300}).value());
  auto scene = RefinementScene::create(*context_, object);
  ASSERT_TRUE(scene);
  for (const int level : {0, 1, 3}) {
    auto method = StaticMeshMethod::uniform(*scene, level);
    ASSERT_TRUE(method) << format_error(method.error());
    ASSERT_TRUE(method->refine(kView));
    const auto expected =
        object.refine_with(std::vector<float>(object.topology().edge_count(), static_cast<float>(level)));
    ASSERT_TRUE(expected);
    const Mesh& mesh = expected->mesh;
    ASSERT_EQ(mesh.face_count(), object.mesh().face_count() << 2 * level);
    EXPECT_EQ(method->triangle_count(), mesh.face_count());
    const std::vector<CapturedVertex> seen = capture(*method, 3 * mesh.face_count() + 300);
    ASSERT_EQ(seen.size(), 3 * mesh.face_count());
    for (std::size_t i = 0; i < seen.size(); ++i)
      ASSERT_EQ(seen[i].position, mesh.positions[mesh.faces[i / 3][i % 3]]) << "corner " << i;
  }
}

TEST_F(StaticMesh, DrawsEveryInstanceAndEveryMaterialsFaces) {
  Mesh two = make_shape(Shape::kCube).value();
  two.materials.resize(3);
  two.face_materials.resize(two.face_count());
  for (std::size_t f = 0; f < two.face_count(); ++f)
    two.face_materials[f] = f % 2 == 0 ? 2 : 0;
  const Refiner cube = refiner(two), sheet = refiner(rectangle(Vec2(0, 0), Vec2(1, 1)));
  const Refiner* const objects[] = {&cube, &sheet};
  const RefinementInstance instances[] = {{0, Mat4(1.0f)}, {1, Mat4(1.0f)}, {0, Mat4(1.0f)}};
  auto scene = RefinementScene::create(*context_, objects, instances);
  ASSERT_TRUE(scene);
  auto method = StaticMeshMethod::coarse(*scene);
  ASSERT_TRUE(method);
  ASSERT_TRUE(method->refine(kView));
  EXPECT_EQ(method->triangle_count(), 2 * two.face_count() + 2);
  EXPECT_EQ(capture(*method, 300).size(), 3 * method->triangle_count());
}

}  // namespace
}  // namespace limn::test
