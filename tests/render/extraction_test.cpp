#include "limn/render/extraction.h"

#include <bit>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>

#include "limn/base/bounds.h"
#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"

#include "render/drawing_test.h"
#include "support/stable.h"
#include "support/temp_folder.h"

namespace limn {
namespace {

constexpr Compaction kMethods[] = {Compaction::kHistogramPyramid, Compaction::kScan};

/// A mesh and what extraction needs of it.
struct Model {
  explicit Model(std::string model_name, Mesh model)
      : name(std::move(model_name)),
        mesh(std::move(model)),
        topology(build_topology(mesh)),
        planes(face_planes(mesh)) {}

  SceneObject object() const { return {&topology, planes, mesh.positions}; }
  std::vector<EdgeId> brute(const Eye& eye) const {
    std::vector<EdgeId> edges;
    extract_silhouette_brute(topology, planes, eye, edges);
    return edges;
  }

  std::string name;
  Mesh mesh;
  Topology topology;
  std::vector<Plane> planes;
};

std::vector<Model> awkward_models() {
  std::vector<Model> models;
  for (test::StableMesh& stable : test::awkward_meshes())
    models.emplace_back(std::move(stable.name), std::move(stable.mesh));
  return models;
}

Model model_of(Shape shape, std::size_t faces) {
  return Model("shape", *make_shape(shape, {.faces = faces}));
}

/// Eyes in and around a mesh, on planes of its faces, at its vertices, far away, and directions.
std::vector<Eye> eyes_around(const Model& model, std::size_t random_eyes, std::uint64_t seed) {
  std::vector<Eye> eyes = {{Vec3(0), false}, {Vec3(0, 0, 1), true}, {Vec3(1, 0, 0), true}, {Vec3(0, -1e-40f, 1), true}};
  Random random(seed);
  const std::vector<Vec3>& points = model.mesh.positions;
  Vec3 low(0), high(1);
  if (!points.empty()) low = high = points[0];
  for (const Vec3& p : points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const DVec3 middle = 0.5 * (DVec3(low) + DVec3(high));
  const double size = std::max(glm::length(DVec3(high) - DVec3(low)), 1e-44);
  eyes.push_back({Vec3(middle), false});
  for (std::size_t i = 0; i < random_eyes; ++i) {
    constexpr double kRadii[] = {0.3, 0.8, 3.0, 1e5};
    eyes.push_back({Vec3(middle + kRadii[i % 4] * size * DVec3(random.direction())), false});
    eyes.push_back({random.direction(), true});
    if (points.empty() || model.mesh.faces.empty()) continue;
    const Vec3& a = points[random.below(points.size())];
    const Vec3& b = points[random.below(points.size())];
    eyes.push_back({a, false});
    eyes.push_back({Vec3(0.5 * (DVec3(a) + DVec3(b))), false});
    const Triangle& t = model.mesh.faces[random.below(model.mesh.faces.size())];
    eyes.push_back({Vec3(DVec3(points[t[0]]) + 3.0 * (DVec3(points[t[1]]) - DVec3(points[t[2]]))), false});
    eyes.push_back({Vec3(DVec3(points[t[1]]) - DVec3(points[t[0]])), true});
  }
  std::erase_if(eyes, [](const Eye& eye) { return !is_finite(eye.at) || (eye.orthographic && eye.at == Vec3(0)); });
  return eyes;
}

/// The largest difference, in units of 2^-24 (half the spacing of floats just below 1).
double largest_difference(std::span<const float> a, std::span<const float> b) {
  double largest = a.size() == b.size() ? 0.0 : INFINITY;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])) * 0x1.0p24);
  return largest;
}

class ExtractionTest : public test::DrawingTest {
 protected:
  SceneExtractor make(std::span<const Model> models, const SceneExtractorOptions& options = {}) {
    std::vector<SceneObject> objects;
    for (const Model& model : models)
      objects.push_back(model.object());
    auto made = SceneExtractor::create(*context_, objects, options);
    EXPECT_TRUE(made) << format_error(made.error());
    return std::move(*made);
  }

  /// Extracts by both methods and compares with brute force, object by object.
  void expect_brute_set(SceneExtractor& extractor, std::span<const Model> models, std::span<const Eye> eyes) {
    for (const Compaction method : kMethods) {
      const auto done = extractor.extract(eyes, method);
      ASSERT_TRUE(done) << format_error(done.error());
      const SceneExtractor::Lists lists = extractor.read_silhouettes();
      ASSERT_EQ(lists.offsets.size(), models.size() + 1);
      EXPECT_EQ(lists.offsets.back(), lists.edges.size());
      for (std::size_t o = 0; o < models.size(); ++o) {
        const std::span<const EdgeId> found =
            std::span(lists.edges).subspan(lists.offsets[o], lists.offsets[o + 1] - lists.offsets[o]);
        const std::vector<EdgeId> expected = models[o].brute(eyes[o]);
        EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()))
            << models[o].name << " from " << eyes[o].at.x << " " << eyes[o].at.y << " " << eyes[o].at.z
            << (eyes[o].orthographic ? " orthographic" : "") << ": " << found.size() << " instead of "
            << expected.size();
      }
    }
  }

  void expect_facing(std::span<const Model> model, std::span<const Eye> eye) {
    SceneExtractor extractor = make(model);
    ASSERT_TRUE(extractor.extract(eye));
    std::vector<std::uint8_t> expected;
    classify_faces(model[0].planes, eye[0], expected);
    EXPECT_TRUE(extractor.read_facing() == expected)
        << model[0].name << " from " << eye[0].at.x << " " << eye[0].at.y << " " << eye[0].at.z;
  }
};

TEST_F(ExtractionTest, EachAwkwardMeshGivesTheSetOfBruteForceFromManyEyes) {
  for (const Model& model : awkward_models()) {
    SceneExtractor extractor = make(std::span(&model, 1));
    for (const Eye& eye : eyes_around(model, 6, 1))
      expect_brute_set(extractor, std::span(&model, 1), std::span(&eye, 1));
  }
}

TEST_F(ExtractionTest, ASceneOfThemAllIsExtractedInOnePassEachObjectFromItsOwnEye) {
  std::vector<Model> models;
  models.emplace_back("empty first", Mesh{});
  for (Model& model : awkward_models())
    models.push_back(std::move(model));
  models.push_back(model_of(Shape::kTorus, 3000));
  models.emplace_back("empty last", Mesh{});
  SceneExtractor extractor = make(models);
  std::vector<std::vector<Eye>> choices;
  for (std::size_t o = 0; o < models.size(); ++o)
    choices.push_back(eyes_around(models[o], 10, o));
  for (std::size_t view = 0; view < 60; ++view) {
    std::vector<Eye> eyes;
    for (std::size_t o = 0; o < models.size(); ++o)
      eyes.push_back(choices[o][(view + 5 * o) % choices[o].size()]);
    expect_brute_set(extractor, models, eyes);
  }
}

TEST_F(ExtractionTest, FacingIsThatOfThePredicateBitForBit) {
  for (const Model& model : awkward_models()) {
    for (const Eye& eye : eyes_around(model, 6, 2))
      expect_facing(std::span(&model, 1), std::span(&eye, 1));
  }
}

/// Faces (without edges) whose planes nearly cancel for the eye, at a magnitude; some have subnormal normals.
Model cancelling_planes(int exponent, Eye& eye) {
  Random random(static_cast<std::uint64_t>(exponent + 200));
  const auto any_float = [&random](int low, int high) {
    const int e = low + static_cast<int>(random.below(static_cast<std::uint64_t>(high - low)));
    const double magnitude = std::ldexp(random.uniform(1.0, 2.0), e);
    return static_cast<float>(random.below(2) == 0 ? magnitude : -magnitude);
  };
  const auto coordinate = [&] { return any_float(exponent, exponent + 3); };
  eye = {Vec3(coordinate(), coordinate(), coordinate()), random.below(4) == 0};
  Model model("planes", Mesh{});
  for (int f = 0; f < 3000; ++f) {
    Plane p{any_float(f % 40 == 0 ? -149 : -20, 0), any_float(-10, 0), any_float(-30, 0), 0};
    const float sum = p.nx * eye.at.x + p.ny * eye.at.y + p.nz * eye.at.z;
    p.d = std::bit_cast<float>(std::bit_cast<std::uint32_t>(-sum) + static_cast<std::uint32_t>(random.below(3)));
    model.planes.push_back(p);
  }
  model.topology.faces.resize(model.planes.size());
  return model;
}

TEST_F(ExtractionTest, FacingOfPlanesThatNearlyCancelIsExactDownToSubnormalNumbers) {
  for (int exponent = -149; exponent < 60; exponent += 3) {
    Eye eye;
    const Model model = cancelling_planes(exponent, eye);
    expect_facing(std::span(&model, 1), std::span(&eye, 1));
  }
}

/// The shaders' folder, copied, the predicate's fast way made to take subnormal numbers for 0 as GLSL allows.
void write_flushing_shaders(const test::TempFolder& folder) {
  const std::filesystem::path shaders = std::filesystem::path(LIMN_SOURCE_DIR) / "shaders";
  for (const auto& file : std::filesystem::directory_iterator(shaders))
    folder.write(file.path().filename().string(), test::slurp(file.path()));
  std::string text = test::slurp(shaders / "facing.glsl");
  const std::size_t begin = text.find("  precise float side =");
  const std::size_t end = text.find('\n', begin);
  ASSERT_NE(begin, std::string::npos);
  text.replace(begin, end - begin, R"(
  vec4 q = vec4(flushed(p.x), flushed(p.y), flushed(p.z), flushed(p.w));
  precise float x = flushed(q.x * flushed(at.x));
  precise float y = flushed(q.y * flushed(at.y));
  precise float z = flushed(q.z * flushed(at.z));
  precise float xy = flushed(x + y);
  precise float xyz = flushed(xy + z);
  precise float side = flushed(xyz + ((eye.w & kEyeOrthographic) != 0u ? 0.0 : q.w));)");
  const std::size_t function = text.find("bool faces_eye(");
  ASSERT_NE(function, std::string::npos);
  text.insert(function, "float flushed(float v) { return (floatBitsToUint(v) & 0x7f800000u) == 0u ? 0.0 : v; }\n");
  folder.write("facing.glsl", text);
}

TEST_F(ExtractionTest, FacingIsTheSameOnDevicesThatFlushSubnormalNumbers) {
  const test::TempFolder folder;
  write_flushing_shaders(folder);
  auto made = gl::Context::create({folder.path()});
  ASSERT_TRUE(made);
  context_ = std::move(*made);
  for (int exponent = -149; exponent < 60; exponent += 3) {
    Eye eye;
    const Model model = cancelling_planes(exponent, eye);
    expect_facing(std::span(&model, 1), std::span(&eye, 1));
  }
  // Subnormal numbers times large ones: what is flushed is large.
  Model subnormal_normal("a subnormal normal", Mesh{});
  subnormal_normal.planes = {
      {0x1p-130f, 0.5f, 0, -1.03f}, {0x1p-130f, 0.5f, 0, -1.2f}, {-0x1p-140f, 0.5f, 0, -0.99999f}};
  subnormal_normal.topology.faces.resize(3);
  const Eye far_off{Vec3(0x1p126f, 2, 0), false};
  expect_facing(std::span(&subnormal_normal, 1), std::span(&far_off, 1));
  Model large_normal("a subnormal eye", Mesh{});
  large_normal.planes = {{0x1p126f, 1, 0, 0}, {-0x1p126f, 1, 0, 0}};
  large_normal.topology.faces.resize(2);
  const Eye subnormal_eye{Vec3(0x1p-130f, -0x1p-5f, 0), false};
  expect_facing(std::span(&large_normal, 1), std::span(&subnormal_eye, 1));
  for (const Model& model : awkward_models()) {
    for (const Eye& eye : eyes_around(model, 2, 6))
      expect_facing(std::span(&model, 1), std::span(&eye, 1));
  }
}

TEST_F(ExtractionTest, SilhouettenessIsThatOfTheCpu) {
  double largest = 0;
  for (const Wedge& wedge : {Wedge{}, Wedge{Wedge::Rule::kQuarter, 0.35f}}) {
    for (const Model& model : awkward_models()) {
      SceneExtractor extractor = make(std::span(&model, 1), {.silhouetteness = true, .wedge = wedge});
      const std::vector<Vec3> normals = face_normals(model.mesh);
      for (const Eye& eye : eyes_around(model, 6, 3)) {
        ASSERT_TRUE(extractor.extract(std::span(&eye, 1)));
        const std::vector<float> expected = edge_silhouetteness(model.mesh, model.topology, normals, eye, wedge);
        const double difference = largest_difference(extractor.read_silhouetteness(), expected);
        EXPECT_LE(difference, 4.0) << model.name;
        largest = std::max(largest, difference);
        expect_brute_set(extractor, std::span(&model, 1), std::span(&eye, 1));
      }
    }
  }
  RecordProperty("largest_difference", std::to_string(largest));
}

/// The faces with a selected edge, and their edges, by sets.
struct Around {
  std::vector<FaceId> faces;
  std::vector<EdgeId> edges;
};
Around around(const Topology& topology, const std::vector<bool>& near) {
  Around result;
  std::set<EdgeId> edges;
  for (FaceId f = 0; f < topology.face_count(); ++f) {
    const std::array<EdgeId, 3>& e = topology.face_edges[f];
    if (e[0] == kInvalidId || !(near[e[0]] || near[e[1]] || near[e[2]])) continue;
    result.faces.push_back(f);
    edges.insert(e.begin(), e.end());
  }
  result.edges.assign(edges.begin(), edges.end());
  return result;
}

TEST_F(ExtractionTest, FacesAroundSelectedEdgesAndTheirEdgesAreThoseOfASlowSearch) {
  for (const Model& model : awkward_models()) {
    SceneExtractor extractor = make(std::span(&model, 1), {.silhouetteness = true, .around = true});
    for (const Eye& eye : eyes_around(model, 2, 4)) {
      ASSERT_TRUE(extractor.extract(std::span(&eye, 1)));
      const std::vector<float> alpha = extractor.read_silhouetteness();
      for (const std::optional<float> above : {std::optional<float>{}, std::optional(0.0f), std::optional(0.7f)}) {
        std::vector<bool> near(model.topology.edge_count(), false);
        for (std::size_t e = 0; e < near.size(); ++e)
          near[e] = above && alpha[e] > *above;
        if (!above) {
          for (const EdgeId e : model.brute(eye))
            near[e] = true;
        }
        const Around expected = around(model.topology, near);
        for (const Compaction method : kMethods) {
          ASSERT_TRUE(extractor.extract_around(above, method));
          EXPECT_EQ(extractor.read_selected_faces(), expected.faces) << model.name;
          EXPECT_EQ(extractor.read_selected_edges(), expected.edges) << model.name;
        }
      }
    }
  }
}

TEST_F(ExtractionTest, MeshesOfManySizesGiveTheSetOfBruteForce) {
  for (const std::size_t faces :
       {std::size_t{20}, std::size_t{320}, std::size_t{5120}, std::size_t{20480}, std::size_t{200'000}}) {
    for (const Shape shape : {Shape::kAsteroid, Shape::kTerrain}) {
      const Model model = model_of(shape, faces);
      SceneExtractor extractor = make(std::span(&model, 1));
      Random random(faces);
      for (int view = 0; view < 4; ++view) {
        const Eye eye{3.0f * random.direction(), view % 2 == 1};
        expect_brute_set(extractor, std::span(&model, 1), std::span(&eye, 1));
      }
    }
  }
}

TEST_F(ExtractionTest, OneCallFindsTheSilhouettesOfOneMesh) {
  const Model model = model_of(Shape::kKnot, 2000);
  const Eye eye{Vec3(1, 2, 3), false};
  for (const Compaction method : kMethods) {
    const auto edges = extract_silhouette_gpu(*context_, model.topology, model.planes, eye, method);
    ASSERT_TRUE(edges) << format_error(edges.error());
    EXPECT_FALSE(edges->empty());
    EXPECT_EQ(*edges, model.brute(eye));
  }
}

TEST_F(ExtractionTest, ASceneOfNothingHasNoSilhouettes) {
  SceneExtractor extractor = make({});
  for (const Compaction method : kMethods) {
    ASSERT_TRUE(extractor.extract({}, method));
    EXPECT_TRUE(extractor.read_silhouettes().edges.empty());
    EXPECT_EQ(extractor.read_silhouettes().offsets, std::vector<std::size_t>{0});
  }
}

TEST_F(ExtractionTest, AnExtractorOutlivesTurnsOfAnotherContext) {
  const Model model = model_of(Shape::kTorus, 500);
  const Eye eye{Vec3(3, 1, 2), false};
  SceneExtractor extractor = make(std::span(&model, 1));
  const auto other = gl::Context::create();
  ASSERT_TRUE(other);
  expect_brute_set(extractor, std::span(&model, 1), std::span(&eye, 1));
}

}  // namespace
}  // namespace limn
