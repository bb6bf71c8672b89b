// Dyken's pipeline against the blend it was published with, on the CPU.
#include "limn/render/refinement/published/dyken.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>

#include "limn/base/random.h"
#include "limn/gl/objects.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/blend.h"
#include "limn/render/camera_block.h"
#include "limn/render/materials.h"
#include "limn/render/refinement/patterns.h"
#include "limn/render/targets.h"

#include "render/capture.h"
#include "render/drawing_test.h"
#include "support/stable.h"

namespace limn::test {
namespace {

constexpr std::uint32_t kUnrefined = 0xffffffffu;
constexpr DykenBasis kBases[] = {DykenBasis::kNine, DykenBasis::kNinePacked, DykenBasis::kTen};
/// Of the box's diagonal: what sums of floats in another order may differ by, and what 12 bits may.
constexpr double kRounding = 2e-7, kTwelveBits = 1.0 / 4096;

Mesh shape(Shape kind, std::size_t faces) {
  auto mesh = make_shape(kind, {.faces = faces});
  EXPECT_TRUE(mesh);
  return std::move(*mesh);
}

Refiner refiner(Mesh mesh) {
  auto made = Refiner::create(std::move(mesh));
  EXPECT_TRUE(made) << format_error(made.error());
  return std::move(*made);
}

/// About half of the edges 0, the others anything up to the maximum, whole levels among them.
std::vector<float> random_levels(std::size_t edges, int max_level, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> levels(edges, 0.0f);
  for (float& level : levels) {
    const std::uint64_t kind = random.below(4);
    if (kind < 2) continue;
    level = kind == 2 ? static_cast<float>(random.below(static_cast<std::uint64_t>(max_level) + 1))
                      : quantized_level(random.uniform(0.0, max_level));
  }
  return levels;
}

int rounded_up(float level) {
  return static_cast<int>(std::ceil(level));
}

/// The surface of a face at the vertices of P_m, by the CPU, blended as published.
std::vector<Vec3> cpu_points(const Refiner& object, FaceId face, const std::vector<float>& levels, CenterRule center,
                             int m) {
  const Topology& topology = object.topology();
  const Grid grid = make_grid(m);
  std::vector<Vec3> patch_points(grid.vertices.size()), surface(grid.vertices.size());
  const auto n = static_cast<std::size_t>(grid.segments());
  float largest = 0.0f;
  for (int side = 0; side < 3; ++side) {
    const EdgeId e = topology.face_edges[face][static_cast<std::size_t>(side)];
    const Edge& edge = topology.edges[e];
    largest = std::max(largest, levels[e]);
    std::vector<Vec3> curve(n + 1), points(n + 1);
    sample_edge(object.mesh().positions[edge.v[0]], object.curves()[e], object.mesh().positions[edge.v[1]], levels[e],
                m, Blend::kPaper, curve, points);
    for (std::size_t q = 0; q <= n; ++q) {
      const std::size_t at = topology.runs_forward(face, side) ? q : n - q;
      patch_points[grid.on_side(side, static_cast<int>(q))] = curve[at];
      surface[grid.on_side(side, static_cast<int>(q))] = points[at];
    }
  }
  sample_interior(grid, make_patch(object.mesh(), topology, object.curves(), face, center), largest, Blend::kPaper,
                  patch_points, surface);
  return surface;
}

/// What a face's edges ask for: m, or -1 of a degenerate face.
int level_of(const Refiner& object, FaceId face, const std::vector<float>& levels) {
  const auto& edges = object.topology().face_edges[face];
  if (edges[0] == kInvalidId) return -1;
  return rounded_up(std::max({levels[edges[0]], levels[edges[1]], levels[edges[2]]}));
}

std::uint64_t expected_triangles(const Refiner& object, const std::vector<float>& levels) {
  std::uint64_t count = 0;
  for (FaceId f = 0; f < object.mesh().face_count(); ++f) {
    const int m = level_of(object, f, levels);
    if (m >= 0) count += std::uint64_t{1} << (2 * m);
  }
  return count;
}

std::vector<CapturedVertex> drawn(DykenMethod& method) {
  std::vector<CapturedVertex> all = capture(method, 3 * method.triangle_count() + 3 * 40000);
  std::erase_if(all, [](const CapturedVertex& v) { return v.face == kUnrefined && v.place == kUnrefined; });
  return all;
}

struct Drawing {
  std::unique_ptr<RefinementScene> scene;
  std::unique_ptr<DykenMethod> method;
};

class Dyken : public DrawingTest {
 protected:
  Drawing make(const Refiner& object, const DykenOptions& options, bool deforming = false) {
    Drawing drawing;
    auto scene = RefinementScene::create(*context_, object, {.deforming = deforming});
    EXPECT_TRUE(scene) << format_error(scene.error());
    drawing.scene = std::make_unique<RefinementScene>(std::move(*scene));
    auto method = DykenMethod::create(*drawing.scene, options);
    EXPECT_TRUE(method) << format_error(method.error());
    drawing.method = std::make_unique<DykenMethod>(std::move(*method));
    return drawing;
  }

  /// Draws from given levels and compares every corner drawn with the CPU's. \returns the worst distance, of the box's
  /// diagonal
  double worst_distance(const Refiner& object, DykenOptions options, const std::vector<float>& levels) {
    const Drawing drawing = make(object, options);
    drawing.method->levels().give(levels);
    EXPECT_TRUE(drawing.method->refine(kFront));
    const std::vector<CapturedVertex> corners = drawn(*drawing.method);
    EXPECT_EQ(corners.size(), 3 * expected_triangles(object, levels));
    EXPECT_EQ(drawing.method->triangle_count(), expected_triangles(object, levels));
    std::vector<float> meant = levels;
    if (!options.blending)
      std::transform(meant.begin(), meant.end(), meant.begin(), [](float s) { return std::ceil(s); });
    return compare(object, options, meant, *drawing.method, corners);
  }

  static double compare(const Refiner& object, const DykenOptions& options, const std::vector<float>& levels,
                        const DykenMethod& method, std::span<const CapturedVertex> corners) {
    const CenterRule center = options.basis == DykenBasis::kTen ? CenterRule::kPn : CenterRule::kMean;
    const double diagonal = face_bounds(object.mesh()).diagonal();
    std::size_t next = 0;
    while (next < corners.size() && corners[next].face == kUnrefined)
      ++next;
    double worst = 0.0;
    for (const DykenMethod::RefinedFace& refined : method.refined_faces()) {
      const Grid grid = make_grid(refined.level);
      const std::vector<Vec3> points = cpu_points(object, refined.face, levels, center, refined.level);
      for (const auto& triangle : grid.triangles) {
        for (const std::uint32_t v : triangle) {
          if (next == corners.size()) return INFINITY;
          const CapturedVertex& seen = corners[next++];
          EXPECT_EQ(seen.face, refined.face);
          EXPECT_EQ(seen.j(), grid.vertices[v].j);
          EXPECT_EQ(seen.k(), grid.vertices[v].k);
          EXPECT_EQ(seen.level(), static_cast<std::uint32_t>(refined.level));
          worst = std::max(worst, glm::length(DVec3(seen.position) - DVec3(points[v])) / diagonal);
        }
      }
    }
    EXPECT_EQ(next, corners.size());
    return worst;
  }

  static constexpr View kFront{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};
};

Vec4 texel_of(const BasisTable& table, int x, int y) {
  const auto row = static_cast<std::size_t>(y), column = static_cast<std::size_t>(x);
  return table.texels[row * static_cast<std::size_t>(table.width) + column];
}

TEST(BasisTable, HoldsTheNineFunctionsOfEquation12) {
  for (int level = 0; level <= 5; ++level) {
    const BasisTable table = make_basis_table(DykenBasis::kNine, level);
    const int whole = 1 << level;
    for (int k = 0; k <= whole; ++k) {
      for (int j = 0; j + k <= whole; ++j) {
        const float unit = 1.0f / static_cast<float>(whole);
        const auto expected = nine_basis_functions(static_cast<float>(whole - j - k) * unit,
                                                   static_cast<float>(j) * unit, static_cast<float>(k) * unit);
        float missing = 1.0f;
        for (std::size_t i = 1; i < 9; ++i) {
          const int n = static_cast<int>(i) - 1;
          const float seen = texel_of(table, j * (level + 1) + level, 2 * k + n / 4)[n % 4];
          EXPECT_EQ(seen, expected[i]);
          missing -= seen;
        }
        EXPECT_EQ(missing, expected[0]);
      }
    }
  }
}

/// The functions of a level at a vertex, unpacked, function 0 included.
std::array<float, 10> functions_of(const BasisTable& table, DykenBasis basis, const GridVertex& v, int level) {
  const auto texel = [&](int row) { return texel_of(table, v.j * (table.level + 1) + level, v.k * table.rows + row); };
  std::array<float, 10> f{};
  for (std::size_t i = 0; i < 4; ++i) {
    const float a = texel(0)[static_cast<int>(i)];
    f[1 + i] = basis == DykenBasis::kNinePacked ? std::floor(a) : a;
    f[5 + i] = basis == DykenBasis::kNinePacked ? (a - std::floor(a)) * 4096.0f : texel(1)[static_cast<int>(i)];
  }
  const float whole = basis == DykenBasis::kNinePacked ? static_cast<float>(kPackedWhole) : 1.0f;
  f[0] = basis == DykenBasis::kTen ? texel(2).x : whole - std::accumulate(f.begin() + 1, f.end(), 0.0f);
  if (basis == DykenBasis::kTen) f[9] = texel(2).y;
  return f;
}

TEST(BasisTable, CoarserLevelsAreLinearBetweenTheirVertices) {
  constexpr int kLevel = 5;
  const Grid grid = make_grid(kLevel);
  for (const DykenBasis basis : {DykenBasis::kNine, DykenBasis::kTen}) {
    const BasisTable table = make_basis_table(basis, kLevel);
    for (int level = 0; level < kLevel; ++level) {
      for (const GridVertex& v : grid.vertices) {
        const auto own = functions_of(table, basis, v, level);
        const auto a = functions_of(table, basis, grid.vertices[v.parents[0]], level);
        const auto b = functions_of(table, basis, grid.vertices[v.parents[1]], level);
        const auto finest = functions_of(table, basis, v, kLevel);
        for (std::size_t i = 0; i < own.size(); ++i)
          EXPECT_EQ(own[i], v.level <= level ? finest[i] : 0.5f * (a[i] + b[i])) << "function " << i;
      }
    }
  }
}

TEST(BasisTable, SumsToOneAndPacksTwelveBits) {
  constexpr int kLevel = 6;
  const Grid grid = make_grid(kLevel);
  const BasisTable exact = make_basis_table(DykenBasis::kNine, kLevel);
  const BasisTable packed = make_basis_table(DykenBasis::kNinePacked, kLevel);
  const BasisTable ten = make_basis_table(DykenBasis::kTen, kLevel);
  for (int level = 0; level <= kLevel; ++level) {
    for (const GridVertex& v : grid.vertices) {
      const auto f = functions_of(exact, DykenBasis::kNine, v, level);
      const auto q = functions_of(packed, DykenBasis::kNinePacked, v, level);
      const auto t = functions_of(ten, DykenBasis::kTen, v, level);
      EXPECT_EQ(std::accumulate(t.begin(), t.end(), 0.0f), 1.0f);
      for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(q[i], std::floor(q[i]));
        EXPECT_NEAR(q[i] / static_cast<float>(kPackedWhole), f[i], (i == 0 ? 4.5 : 2.0) / kPackedWhole);
        if (f[i] == 0.0f && (v.i == 0 || v.j == 0 || v.k == 0)) {
          EXPECT_EQ(q[i], 0.0f);
        }
      }
      // An edge looks the same from its other end, in any face: functions turn with the corners.
      const GridVertex turned{v.j, v.k, v.i, v.level, {}};
      const GridVertex mirrored{v.j, v.i, v.k, v.level, {}};
      if (v.k != 0) continue;
      const auto r = functions_of(packed, DykenBasis::kNinePacked, mirrored, level);
      const auto s = functions_of(packed, DykenBasis::kNinePacked, turned, level);
      EXPECT_EQ((std::array{q[0], q[3], q[4], q[1]}), (std::array{r[1], r[4], r[3], r[0]}));
      EXPECT_EQ((std::array{q[0], q[3], q[4], q[1]}), (std::array{s[2], s[7], s[8], s[0]}));
    }
  }
}

TEST_F(Dyken, PutsEveryVertexWhereThePublishedBlendDoes) {
  for (const Shape kind : {Shape::kKnot, Shape::kCube, Shape::kAsteroid, Shape::kSheet}) {
    const Refiner object = refiner(shape(kind, 300));
    for (const int max_level : {1, 3, 4}) {
      const std::vector<float> levels = random_levels(object.topology().edge_count(), max_level, 7);
      for (const DykenBasis basis : kBases) {
        for (const bool blending : {true, false}) {
          DykenOptions options{.basis = basis, .blending = blending};
          options.levels.max_level = max_level;
          const double worst = worst_distance(object, options, levels);
          EXPECT_LT(worst, basis == DykenBasis::kNinePacked ? kTwelveBits : kRounding) << static_cast<int>(basis);
        }
      }
    }
  }
}

TEST_F(Dyken, AwkwardMeshesAreRefinedTheSame) {
  for (const StableMesh& stable : awkward_meshes()) {
    auto object = Refiner::create(stable.mesh);
    if (!object) continue;
    const Bounds bounds = face_bounds(object->mesh());
    const double diagonal = bounds.diagonal();
    if (!(diagonal > 1e-30)) continue;  // a device may take products with such numbers for 0
    const double farthest = std::max(glm::length(DVec3(bounds.low)), glm::length(DVec3(bounds.high)));
    const std::vector<float> levels = random_levels(object->topology().edge_count(), 3, 11);
    EXPECT_LT(worst_distance(*object, {}, levels), kRounding * (diagonal + farthest) / diagonal) << stable.name;
  }
}

TEST_F(Dyken, SelectsTheFacesTheCpuSelects) {
  const Refiner object = refiner(shape(Shape::kKnot, 4000));
  const Drawing drawing = make(object, {});
  for (const Vec3 eye : {Vec3(1.2f, 0.7f, 3.0f), Vec3(-4, 1, 0), Vec3(0.1f, 8, 0.2f)}) {
    const View view{{eye, false}, 1000.0f};
    ASSERT_TRUE(drawing.method->refine(view));
    const std::vector<std::uint16_t> device = drawing.method->levels().read(0);
    std::vector<float> levels(device.size());
    std::transform(device.begin(), device.end(), levels.begin(), [](std::uint16_t u) { return u * kLevelUnit; });
    std::vector<int> expected(object.mesh().face_count(), 0), seen(expected);
    for (FaceId f = 0; f < expected.size(); ++f)
      expected[f] = level_of(object, f, levels);
    for (const auto& [face, level] : drawing.method->refined_faces())
      seen[face] = level;
    EXPECT_EQ(seen, expected);
    EXPECT_EQ(drawing.method->triangle_count(), expected_triangles(object, levels));
    // And the levels are the CPU's, but for a last unit here and there.
    const auto own =
        edge_levels(object.mesh(), object.topology(), face_normals(object.mesh()), object.curves(), view, {});
    ASSERT_TRUE(own);
    for (FaceId f = 0; f < expected.size(); ++f) {
      const auto& edges = object.topology().face_edges[f];
      const float largest = std::max({(*own)[edges[0]], (*own)[edges[1]], (*own)[edges[2]]});
      if (largest == 0.0f || largest > kLevelUnit) {
        EXPECT_EQ(seen[f] > 0, largest > 0.0f) << f;
      }
    }
  }
}

/// Corners by face, for methods that draw faces in another order.
std::map<std::array<std::uint32_t, 2>, Vec3> by_place(std::span<const CapturedVertex> corners) {
  std::map<std::array<std::uint32_t, 2>, Vec3> places;
  for (const CapturedVertex& v : corners)
    places[{v.face, v.place}] = v.position;
  return places;
}

TEST_F(Dyken, DeformingMeshesAreDrawnAsStaticOnesOfTheSameShape) {
  const Refiner before = refiner(shape(Shape::kKnot, 600));
  Mesh bent_mesh = before.mesh();
  const auto bend = [](const Vec3& p) { return Vec3(p.x + 0.3f * p.y * p.y, p.y - 0.2f * p.x * p.z, 1.1f * p.z); };
  for (Vec3& p : bent_mesh.positions)
    p = bend(p);
  const Refiner bent = refiner(bent_mesh);
  DykenOptions options;
  const Drawing deforming = make(before, options, true);
  const Drawing fixed = make(bent, options);
  std::vector<Vec3> moved;
  for (const VertexId v : deforming.scene->vertex_source(0))
    moved.push_back(bent_mesh.positions[v]);
  glNamedBufferSubData(deforming.scene->positions_buffer(), 0, static_cast<GLsizeiptr>(moved.size() * sizeof(Vec3)),
                       moved.data());
  deforming.scene->update_surface();
  ASSERT_TRUE(deforming.method->refine(kFront));
  ASSERT_TRUE(fixed.method->refine(kFront));
  EXPECT_EQ(deforming.method->levels().read(0), fixed.method->levels().read(0));
  const auto a = by_place(drawn(*deforming.method)), b = by_place(drawn(*fixed.method));
  EXPECT_EQ(a.size(), b.size());
  EXPECT_TRUE(a == b);
}

/// The points that a method drew on the inside of edges: by edge and segment of 2^-M from its first end.
struct EdgePoints {
  std::map<std::pair<EdgeId, int>, Vec3> points;
  std::map<EdgeId, std::vector<int>> levels;  ///< m of the faces there
  std::size_t shared = 0, mismatches = 0;
};

EdgePoints edge_points(const Refiner& object, const DykenMethod& method, std::span<const CapturedVertex> corners,
                       int max_level) {
  const Topology& topology = object.topology();
  EdgePoints found;
  for (const auto& [face, level] : method.refined_faces()) {
    for (const EdgeId e : topology.face_edges[face])
      found.levels[e].push_back(level);
  }
  std::map<std::pair<EdgeId, int>, FaceId> owner;
  for (const CapturedVertex& v : corners) {
    if (v.face == kUnrefined) continue;
    const int n = 1 << v.level(), j = static_cast<int>(v.j()), k = static_cast<int>(v.k()), i = n - j - k;
    if (i == n || j == n || k == n || (i != 0 && j != 0 && k != 0)) continue;
    const int side = k == 0 ? 0 : i == 0 ? 1 : 2;
    const int along = side == 0 ? j : side == 1 ? k : i;
    const EdgeId e = topology.face_edges[v.face][static_cast<std::size_t>(side)];
    const int q = (topology.runs_forward(v.face, side) ? along : n - along)
                  << (max_level - static_cast<int>(v.level()));
    const auto [at, first] = found.points.try_emplace({e, q}, v.position);
    if (first) owner[{e, q}] = v.face;
    if (!first && owner[{e, q}] != v.face) ++found.shared;
    for (int c = 0; c < 3; ++c) {
      if (std::bit_cast<std::uint32_t>(at->second[c]) != std::bit_cast<std::uint32_t>(v.position[c]))
        ++found.mismatches;
    }
  }
  return found;
}

TEST_F(Dyken, BothFacesOfAnEdgeFindTheSameBits) {
  const Refiner object = refiner(shape(Shape::kHoles3, 1500));
  for (const DykenBasis basis : kBases) {
    for (const bool blending : {true, false}) {
      const Drawing drawing = make(object, {.basis = basis, .blending = blending});
      drawing.method->levels().give(random_levels(object.topology().edge_count(), 3, 5));
      ASSERT_TRUE(drawing.method->refine(kFront));
      const EdgePoints found = edge_points(object, *drawing.method, drawn(*drawing.method), 3);
      EXPECT_GT(found.shared, 1000u);
      EXPECT_EQ(found.mismatches, 0u) << static_cast<int>(basis);
    }
  }
}

TEST_F(Dyken, AFinerFaceHasVerticesThatItsNeighbourLacksOnTheNeighboursSegments) {
  constexpr int kMax = 3;
  const Refiner object = refiner(shape(Shape::kHoles3, 1500));
  const Topology& topology = object.topology();
  const Drawing drawing = make(object, {});
  drawing.method->levels().give(random_levels(topology.edge_count(), kMax, 5));
  ASSERT_TRUE(drawing.method->refine(kFront));
  const EdgePoints found = edge_points(object, *drawing.method, drawn(*drawing.method), kMax);
  const double diagonal = face_bounds(object.mesh()).diagonal();
  std::size_t extra = 0, off = 0;
  for (const auto& [key, point] : found.points) {
    const auto& [e, q] = key;
    const std::vector<int>& levels = found.levels.at(e);
    const int coarser = levels.size() < 2 ? 0 : std::min(levels[0], levels[1]);
    const int step = 1 << (kMax - coarser);
    if (q % step == 0) continue;
    ++extra;
    const auto end = [&, edge = e](int at) {
      if (at == 0) return object.mesh().positions[topology.edges[edge].v[0]];
      return at == 1 << kMax ? object.mesh().positions[topology.edges[edge].v[1]] : found.points.at({edge, at});
    };
    const int low = q / step * step;
    const double x = static_cast<double>(q - low) / step;
    const DVec3 meant = DVec3(end(low)) * (1.0 - x) + DVec3(end(low + step)) * x;
    EXPECT_LT(glm::length(meant - DVec3(point)) / diagonal, kRounding);
    off += meant != DVec3(point) ? 1u : 0u;
  }
  EXPECT_GT(extra, 500u);
  EXPECT_GT(off, 0u) << "collinear in exact arithmetic only, so some are not";
}

TEST_F(Dyken, AFrameForgetsTheOneBefore) {
  const Refiner object = refiner(shape(Shape::kAsteroid, 1000));
  for (const bool deforming : {false, true}) {
    const Drawing drawing = make(object, {}, deforming);
    const View other{{Vec3(-3, -2, 1), false}, 1000.0f};
    ASSERT_TRUE(drawing.method->refine(kFront));
    const auto first = by_place(drawn(*drawing.method));
    EXPECT_TRUE(by_place(drawn(*drawing.method)) == first);  // a second view of one refinement
    ASSERT_TRUE(drawing.method->refine(other));
    const auto second = by_place(drawn(*drawing.method));
    EXPECT_FALSE(second == first);
    ASSERT_TRUE(drawing.method->refine(kFront));
    EXPECT_TRUE(by_place(drawn(*drawing.method)) == first);
  }
}

TEST_F(Dyken, WithoutLevelsEveryTriangleIsDrawnAsItIs) {
  const Refiner object = refiner(shape(Shape::kKnot, 400));
  const Drawing drawing = make(object, {});
  drawing.method->levels().give(std::vector<float>(object.topology().edge_count(), 0.0f));
  ASSERT_TRUE(drawing.method->refine(kFront));
  EXPECT_TRUE(drawing.method->refined_faces().empty());
  EXPECT_EQ(drawing.method->triangle_count(), object.mesh().face_count());
  EXPECT_EQ(drawn(*drawing.method).size(), 3 * object.mesh().face_count());
  EXPECT_GT(drawing.method->device_bytes(), 0u);
}

TEST_F(Dyken, LevelsOutOfRangeAreRefused) {
  const Refiner object = refiner(shape(Shape::kKnot, 400));
  auto scene = RefinementScene::create(*context_, object);
  ASSERT_TRUE(scene);
  DykenOptions options;
  options.levels.max_level = kMaxLevel + 1;
  const auto method = DykenMethod::create(*scene, options);
  ASSERT_FALSE(method);
  EXPECT_EQ(method.error().code, ErrorCode::kInvalidArgument);
}

class DykenPicture : public Dyken {
 protected:
  static constexpr int kSide = 256;

  Image picture(RefinementMethod& method, const RefinementScene& scene, const Camera& camera) {
    const auto targets = RenderTargets::create(kSide, kSide, 4);
    const auto materials = MaterialTable::create(scene.meshes());
    EXPECT_TRUE(targets && materials);
    EXPECT_TRUE(method.refine(view_of(camera, kSide)));
    const CameraBuffer buffer;
    buffer.update(make_camera_block(camera, kSide, kSide));
    buffer.bind();
    materials->bind();
    targets->begin_faces();
    EXPECT_TRUE(method.draw({}));
    auto image = targets->resolve(*context_, kWhite);
    EXPECT_TRUE(image);
    return std::move(*image);
  }
};

TEST_F(DykenPicture, LooksLikeTheSameSurfaceDrawnByPatterns) {
  const Refiner object = refiner(shape(Shape::kKnot, 600));
  PatternMethodOptions published;
  published.blend = Blend::kPaper;
  auto scene = RefinementScene::create(*context_, object, {.center = CenterRule::kMean});
  ASSERT_TRUE(scene);
  auto patterns = PatternMethod::create(*scene, published);
  ASSERT_TRUE(patterns);
  const Drawing drawing = make(object, {}), coarse = make(object, {.levels = {.max_level = 0}}),
                deforming = make(object, {}, true);
  for (const Vec3 eye : {Vec3(0.5f, 0.4f, 4.0f), Vec3(3, 2, -1)}) {
    Camera camera;
    camera.eye = eye;
    camera.target = face_bounds(object.mesh()).center();
    const Image image = picture(*drawing.method, *drawing.scene, camera);
    // Where a neighbour is finer, patterns fan the border, and light is interpolated over other triangles; and a
    // T-vertex lets a sample through now and then.
    const Image other = picture(*patterns, *scene, camera);
    EXPECT_LT(compare_images(image, other, 8).failing_share, 0.004);
    EXPECT_LT(compare_images(image, other, 32).failing_share, 0.0003);
    EXPECT_LT(compare_images(image, picture(*deforming.method, *deforming.scene, camera), 2).failing_share, 0.0003);
    EXPECT_GT(compare_images(image, picture(*coarse.method, *coarse.scene, camera), 8).failing_share, 0.005);
  }
}

}  // namespace
}  // namespace limn::test
