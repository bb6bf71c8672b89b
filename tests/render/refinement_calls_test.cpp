#include <filesystem>
#include <regex>

#include "limn/mesh/shapes.h"
#include "limn/render/camera_block.h"
#include "limn/render/materials.h"
#include "limn/render/refinement/patterns.h"
#include "limn/render/targets.h"

#include "render/drawing_test.h"
#include "render/gl_calls.h"

namespace limn::test {
namespace {

namespace fs = std::filesystem;

using Calls = std::map<std::string, std::uint64_t>;

/// A frame's setting: where it is drawn and what the fragments read.
struct Stage {
  RenderTargets targets;
  MaterialTable materials;
  CameraBuffer camera;
};

class RefinementCalls : public DrawingTest {
 protected:
  static Refiner knot(std::size_t faces) {
    auto mesh = make_shape(Shape::kKnot, {.faces = faces});
    EXPECT_TRUE(mesh);
    auto made = Refiner::create(std::move(*mesh));
    EXPECT_TRUE(made);
    return std::move(*made);
  }

  static Stage stage(const Refiner& object) {
    auto targets = RenderTargets::create(32, 32, 1);
    auto materials = MaterialTable::create(object.mesh());
    EXPECT_TRUE(targets);
    EXPECT_TRUE(materials);
    Stage made{std::move(*targets), std::move(*materials), {}};
    made.materials.bind();
    made.camera.bind();
    return made;
  }

  /// Refined from one view, drawn in two: the camera's, shaded, and another's, for its depths alone.
  static void frame(PatternMethod& method, const Stage& stage, float turn_rad) {
    const Camera camera = fit_camera(Bounds{Vec3(-1), Vec3(1)}, turn_rad, 0.3f);
    ASSERT_TRUE(method.refine(view_of(camera, 32)));
    stage.targets.begin_faces();
    stage.camera.update(make_camera_block(camera, 32, 32));
    ASSERT_TRUE(method.draw({}));
    const Camera light = fit_camera(Bounds{Vec3(-1), Vec3(1)}, turn_rad + 1.0f, 1.0f);
    stage.camera.update(make_camera_block(light, 32, 32));
    ASSERT_TRUE(method.draw({.stage = SurfaceStage::kPositions}));
  }

  /// What two frames call, once a frame before has made the programs.
  static Calls calls_of(PatternMethod& method, const Stage& stage) {
    frame(method, stage, 0.0f);
    const GlCallCounter counter;
    for (const float turn : {1.0f, 4.0f})
      frame(method, stage, turn);
    return counter.counts();
  }
};

TEST_F(RefinementCalls, CountsEveryFunctionThatTheLibraryUses) {
  const std::regex call(R"(\bgl[A-Z]\w+)");
  std::size_t seen = 0;
  for (const char* folder : {"src/limn/gl", "src/limn/render"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(LIMN_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
      const std::string text = slurp(entry.path());
      for (std::sregex_iterator i(text.begin(), text.end(), call), end; i != end; ++i, ++seen)
        EXPECT_TRUE(GlCallCounter::knows(i->str())) << i->str() << " in " << entry.path();
    }
  }
  EXPECT_GT(seen, 100u);
}

TEST_F(RefinementCalls, SeesWhatWaitsAndWhatIsNotCalled) {
  const Refiner object = knot(1000);
  auto scene = RefinementScene::create(*context_, object);
  ASSERT_TRUE(scene);
  const auto method = PatternMethod::create(*scene);
  ASSERT_TRUE(method);
  const GlCallCounter counter;
  EXPECT_TRUE(counter.counts().empty());
  EXPECT_EQ(method->triangle_count(), 0u);
  const Calls calls = counter.counts();
  ASSERT_TRUE(calls.contains("glGetNamedBufferSubData"));
  EXPECT_TRUE(waits_or_reads("glGetNamedBufferSubData"));
  GlCallCounter::reset();
  EXPECT_TRUE(counter.counts().empty());
}

TEST_F(RefinementCalls, AreAsManyForAMillionTrianglesAsForAThousandAndNoneWaits) {
  std::map<std::string, Calls> first;
  for (const std::size_t faces : {1000u, 30000u, 1000000u}) {
    const Refiner object = knot(faces);
    auto scene = RefinementScene::create(*context_, object);
    ASSERT_TRUE(scene);
    const Stage place = stage(object);
    for (const PatternFamily family : {PatternFamily::kNested, PatternFamily::kMinimal}) {
      for (const bool store : {false, true}) {
        for (const bool budget : {false, true}) {
          if (faces > 30000 && (family == PatternFamily::kMinimal || store != budget)) continue;  // for time
          PatternMethodOptions options;
          options.levels.max_level = 1;
          options.family = family;
          options.store = store;
          options.triangle_budget = budget ? faces + faces / 10 : 0;
          auto method = PatternMethod::create(*scene, options);
          ASSERT_TRUE(method) << format_error(method.error());
          const Calls calls = calls_of(*method, place);
          std::uint64_t sum = 0;
          for (const auto& [name, count] : calls) {
            EXPECT_FALSE(waits_or_reads(name)) << name << " " << count << " times at " << faces << " faces";
            sum += count;
          }
          EXPECT_GT(sum, 40u);
          EXPECT_GT(calls.at("glMultiDrawElementsIndirect"), 0u);
          const std::string key = std::string(family == PatternFamily::kNested ? "nested" : "minimal") +
                                  (store ? ", stored" : ", vertex stage") + (budget ? ", budget" : "");
          const auto [known, made] = first.try_emplace(key, calls);
          if (made)
            RecordProperty(key, std::to_string(sum / 2) + " calls a frame");
          else
            EXPECT_EQ(calls, known->second) << key << " at " << faces << " faces";
        }
      }
    }
  }
}

}  // namespace
}  // namespace limn::test
