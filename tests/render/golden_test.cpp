// Pictures compared with ones that were looked at and kept. To replace them after a change that is meant:
//   LIMN_UPDATE_GOLDEN=1 build/release/tests/test_render --gtest_filter='Golden.*'
// and look at what changed before committing it. A failing test leaves its picture, and where it differs, in the build
// folder.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <vector>

#include "limn/mesh/shapes.h"
#include "limn/mesh/topology.h"

#include "drawing_test.h"

namespace limn {
namespace {

constexpr int kSize = 256;
// Drivers round differently, and where an edge or a highlight falls that moves a few pixels: a channel may be off by 6
// of 255, and half a percent of the pixels by more.
constexpr int kTolerance = 6;
constexpr double kFailingShare = 0.005;

class Golden : public test::DrawingTest {
 protected:
  static Mesh shape(Shape which, std::size_t faces) {
    ShapeOptions options;
    options.faces = faces;
    auto mesh = make_shape(which, options);
    EXPECT_TRUE(mesh) << format_error(mesh.error());
    return mesh ? std::move(*mesh) : Mesh();
  }

  static Camera camera_for(const Mesh& mesh, float azimuth_rad = 0.5f, float elevation_rad = 0.4f,
                           bool orthographic = false) {
    CameraFit fit;
    fit.orthographic = orthographic;
    return fit_camera(face_bounds(mesh), azimuth_rad, elevation_rad, fit);
  }

  static RenderOptions options() { return test::picture_options(kSize, kSize, 4, test::kWhite); }

  static void expect_golden(const Image& image, const std::string& name) {
    const std::filesystem::path golden =
        std::filesystem::path(LIMN_SOURCE_DIR) / "tests/render/golden" / (name + ".png");
    if (std::getenv("LIMN_UPDATE_GOLDEN") != nullptr) {
      std::filesystem::create_directories(golden.parent_path());
      ASSERT_TRUE(write_png(image, golden));
      return;
    }
    const auto expected = read_png(golden);
    ASSERT_TRUE(expected) << format_error(expected.error());
    const ImageDifference difference = compare_images(image, *expected, kTolerance);
    if (difference.failing_share <= kFailingShare) return;
    const std::filesystem::path folder = std::filesystem::path(LIMN_BINARY_DIR) / "golden-failures";
    std::filesystem::create_directories(folder);
    EXPECT_TRUE(write_png(image, folder / (name + ".actual.png")));
    EXPECT_TRUE(write_png(difference.picture, folder / (name + ".diff.png")));
    ADD_FAILURE() << 100.0 * difference.failing_share << " % of the pixels differ by more than " << kTolerance
                  << ", the most by " << difference.largest << "\nexpected " << golden << "\nactual   "
                  << folder / (name + ".actual.png") << "\ndiff     " << folder / (name + ".diff.png");
  }
};

/// Edges between a face towards the eye and one away from it, found the plain way.
std::vector<Segment3> outline(const Mesh& mesh, const Camera& camera) {
  const Topology topology = build_topology(mesh);
  const auto faces_eye = [&](FaceId f) {
    const Triangle& face = mesh.faces[f];
    const DVec3 a(mesh.positions[face[0]]), u = DVec3(mesh.positions[face[1]]) - a,
                                            v = DVec3(mesh.positions[face[2]]) - a;
    const DVec3 n(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x), w = DVec3(camera.eye) - a;
    return n.x * w.x + n.y * w.y + n.z * w.z > 0.0;
  };
  std::vector<Segment3> segments;
  for (const Edge& edge : topology.edges) {
    if (edge.face[1] != kInvalidId && faces_eye(edge.face[0]) == faces_eye(edge.face[1])) continue;
    segments.push_back({mesh.positions[edge.v[0]], mesh.positions[edge.v[1]], Vec3(0.06f, 0.07f, 0.10f)});
  }
  return segments;
}

/// Every edge, coloured by its height in the mesh: a stand-in for levels.
std::vector<Segment3> colored_edges(const Mesh& mesh) {
  const Bounds bounds = face_bounds(mesh);
  std::vector<Segment3> segments;
  for (const Edge& edge : build_topology(mesh).edges) {
    const Vec3& a = mesh.positions[edge.v[0]];
    const Vec3& b = mesh.positions[edge.v[1]];
    const float level = 3.0f * (0.5f * (a.x + b.x) - bounds.low.x) / (bounds.high.x - bounds.low.x);
    segments.push_back({a, b, level_color(level, 3.0f)});
  }
  return segments;
}

TEST_F(Golden, KnotLit) {
  const Mesh mesh = shape(Shape::kKnot, 20000);
  expect_golden(draw(mesh, camera_for(mesh), options()), "knot_lit");
}

TEST_F(Golden, KnotCoarseWireframe) {
  const Mesh mesh = shape(Shape::kKnot, 1000);
  RenderOptions wires = options();
  wires.wireframe = true;
  expect_golden(draw(mesh, camera_for(mesh), wires), "knot_coarse_wireframe");
}

TEST_F(Golden, CubeWithHardEdgesOrthographic) {
  const Mesh mesh = shape(Shape::kCube, 0);
  expect_golden(draw(mesh, camera_for(mesh, 0.6f, 0.5f, true), options()), "cube_orthographic");
}

TEST_F(Golden, AsteroidOnTransparency) {
  const Mesh mesh = shape(Shape::kAsteroid, 5000);
  RenderOptions transparent = options();
  transparent.background = test::kTransparent;
  expect_golden(draw(mesh, camera_for(mesh), transparent), "asteroid_transparent");
}

TEST_F(Golden, TorusFlatWithOutline) {
  const Mesh mesh = shape(Shape::kTorus, 800);
  RenderOptions flat = options();
  flat.flat = true;
  flat.line_width_px = 2.0f;
  const Camera camera = camera_for(mesh, 0.4f, 0.9f);
  expect_golden(draw(mesh, camera, flat, outline(mesh, camera)), "torus_flat_outline");
}

TEST_F(Golden, Holes3OutlineAlone) {
  const Mesh mesh = shape(Shape::kHoles3, 4000);
  RenderOptions lines = options();
  lines.draw_faces = false;
  const Camera camera = camera_for(mesh, 0.5f, 0.7f);
  expect_golden(draw(mesh, camera, lines, outline(mesh, camera)), "holes3_outline_alone");
}

TEST_F(Golden, IcosphereWithColouredEdges) {
  const Mesh mesh = shape(Shape::kIcosphere, 320);
  expect_golden(draw(mesh, camera_for(mesh), options(), colored_edges(mesh)), "icosphere_colored_edges");
}

TEST_F(Golden, TerrainOneSampleOnDark) {
  const Mesh mesh = shape(Shape::kTerrain, 8000);
  RenderOptions dark = options();
  dark.samples = 1;
  dark.background = Vec4(0.10f, 0.11f, 0.14f, 1.0f);
  expect_golden(draw(mesh, camera_for(mesh, 0.6f, 0.6f), dark), "terrain_one_sample_dark");
}

TEST_F(Golden, SheetSeenFromBehindWithVertexColours) {
  Mesh mesh = shape(Shape::kSheet, 800);
  mesh.colors = {};
  for (const Vec3& p : mesh.positions)
    mesh.colors.values.emplace_back(0.5f + 0.5f * p.x, 0.4f, 0.5f - 0.5f * p.x, 1.0f);
  expect_golden(draw(mesh, camera_for(mesh, 3.5f, -0.4f), options()), "sheet_behind_colors");
}

TEST_F(Golden, MetalBesideRoughPlastic) {
  Mesh mesh = shape(Shape::kIcosphere, 5120);
  const Mesh second = mesh;
  const auto count = static_cast<VertexId>(mesh.positions.size());
  for (const Vec3& p : second.positions)
    mesh.positions.push_back(p + Vec3(2.1f, 0, 0));
  mesh.normals.values.insert(mesh.normals.values.end(), second.normals.values.begin(), second.normals.values.end());
  for (const Triangle& face : second.faces)
    mesh.faces.push_back({face[0] + count, face[1] + count, face[2] + count});
  mesh.uvs = {};
  ASSERT_TRUE(mesh.normals.indices.empty());
  mesh.face_materials.assign(second.face_count(), 0);
  mesh.face_materials.resize(mesh.face_count(), 1);
  mesh.materials.resize(2);
  mesh.materials[0].base_color = Vec4(0.9f, 0.6f, 0.2f, 1.0f);
  mesh.materials[0].metallic = 1.0f;
  mesh.materials[0].roughness = 0.3f;
  mesh.materials[1].base_color = Vec4(0.1f, 0.3f, 0.7f, 1.0f);
  mesh.materials[1].roughness = 0.9f;
  expect_golden(draw(mesh, camera_for(mesh, 0.0f, 0.3f), options()), "metal_and_plastic");
}

/// A normal map of round studs in a square grid, as if turned on a lathe: a rim, a flat top.
Image studs(int size, int per_side) {
  Image map(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const auto in_cell = [&](int i) {
        const float t = (static_cast<float>(i) + 0.5f) * static_cast<float>(per_side) / static_cast<float>(size);
        return t - std::floor(t) - 0.5f;
      };
      const float at_x = in_cell(x), at_y = -in_cell(y);
      const float away = std::hypot(at_x, at_y);
      const float slope = away > 0.18f && away < 0.38f ? 1.2f * std::sin(15.7f * (away - 0.18f)) : 0.0f;
      const Vec3 n = glm::normalize(Vec3(slope * at_x, slope * at_y, away + 1e-6f));
      for (int c = 0; c < 3; ++c)
        map.pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(127.5f * (n[c] + 1.0f)));
      map.pixel(x, y)[3] = 255;
    }
  }
  return map;
}

TEST_F(Golden, TorusWithStudsFromANormalMap) {
  Mesh mesh = shape(Shape::kTorus, 4000);
  ASSERT_FALSE(mesh.uvs.empty());
  Material& material = mesh.materials.emplace_back();
  material.base_color = Vec4(0.55f, 0.23f, 0.12f, 1.0f);
  material.roughness = 0.35f;
  material.normal_image = test::png_of(studs(512, 8));
  for (Vec2& uv : mesh.uvs.values)
    uv.x *= 3.0f;
  CameraFit close;
  close.fill = 1.3f;
  expect_golden(draw(mesh, fit_camera(face_bounds(mesh), 0.4f, 0.9f, close), options()), "torus_studs");
}

}  // namespace
}  // namespace limn
