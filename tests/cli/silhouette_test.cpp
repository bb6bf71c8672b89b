// limn silhouette, seen from outside: formats, layers, options that contradict each other, and the set of edges itself.
#ifdef LIMN_WITH_EMBREE

#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "limn/mesh/import.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/classes.h"

#include "cli/program.h"
#include "support/stable.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

using nlohmann::json;

using Pair = std::pair<VertexId, VertexId>;

class SilhouetteVerb : public testing::Test {
 protected:
  TempFolder folder;
  Program limn{folder.path()};

  void make(const std::string& shape, const std::string& name, int faces) {
    ASSERT_EQ(limn.run({"make", shape, "--faces", std::to_string(faces), "-o", name}).exit, 0);
  }

  /// The drawing of a model as bytes.
  std::string drawn(const std::string& model, const std::string& format, const Arguments& options = {}) {
    Arguments words = {"silhouette", model, "-o", "drawing." + format};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return slurp(folder / ("drawing." + format));
  }
  json edges_of(const std::string& model, const Arguments& options = {}) {
    return json::parse(drawn(model, "json", options));
  }

  void expect_refused(const Arguments& options, const std::string& said) {
    Arguments words = {"silhouette", "missing.ply"};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = limn.run(words);
    EXPECT_EQ(outcome.exit, 2) << testing::PrintToString(options) << outcome.err;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
};

std::set<Pair> listed(const json& drawing, const std::string& line_class) {
  std::set<Pair> found;
  for (const json& edge : drawing["edges"]) {
    if (edge["class"] == line_class) found.emplace(edge["v"][0].get<VertexId>(), edge["v"][1].get<VertexId>());
  }
  return found;
}

std::set<Pair> ends(const Topology& topology, const std::vector<EdgeId>& edges) {
  std::set<Pair> found;
  for (const EdgeId edge : edges)
    found.insert({topology.edges[edge].v[0], topology.edges[edge].v[1]});
  return found;
}

TEST_F(SilhouetteVerb, ListsTheVerySetOfTheOracleByTheFilesVertices) {
  make("asteroid", "rock.stl", 2000);
  make("terrain", "land.ply", 2000);
  for (const std::string model : {"rock.stl", "land.ply"}) {
    const Mesh mesh = read_mesh(folder / model)->mesh;
    const Topology topology = build_topology(mesh);
    for (const Arguments& camera : std::vector<Arguments>{{"--view", "30,20"},
                                                          {"--view", "-100,70", "--ortho"},
                                                          {"--eye", "0.3,0.5,3"},
                                                          {"--eye", "0.01,0.02,0.1"}}) {
      Arguments options = camera;
      options.emplace_back("--all");
      const json drawing = edges_of(model, options);
      const json& at = drawing["eye"]["at"];
      const Eye eye{{at[0].get<float>(), at[1].get<float>(), at[2].get<float>()}, drawing["eye"]["orthographic"]};
      std::vector<EdgeId> oracle;
      extract_silhouette_brute(topology, face_planes(mesh), eye, oracle);
      EXPECT_EQ(listed(drawing, "silhouette"), ends(topology, oracle)) << model;
      EXPECT_EQ(listed(drawing, "boundary"), ends(topology, boundary_edges(topology))) << model;
      EXPECT_EQ(drawing["edges"].size(), drawing["listed"]);
    }
  }
}

TEST_F(SilhouetteVerb, NamesAPositionThatIsStoredTwiceByItsLowestIndex) {
  folder.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_EQ(listed(edges_of("two.obj", {"--view", "0,0"}), "boundary"),
            (std::set<Pair>{{0, 1}, {0, 2}, {1, 5}, {2, 5}}));
}

TEST_F(SilhouetteVerb, EveryMethodDrawsTheSame) {
  make("knot", "knot.ply", 1200);
  const std::string plain = drawn("knot.ply", "svg", {"--all"});
  const auto help = limn.json({"help", "silhouette"})["verbs"][0]["options"];
  const auto method = std::find_if(help.begin(), help.end(), [](const json& o) { return o["name"] == "--method"; });
  ASSERT_NE(method, help.end());
  for (const std::string name : (*method)["choices"]) {
    EXPECT_TRUE(drawn("knot.ply", "svg", {"--all", "--method", name}) == plain) << name;
    EXPECT_EQ(edges_of("knot.ply", {"--method", name})["method"], name == "auto" ? "brute" : name);
  }
}

TEST_F(SilhouetteVerb, DrawsTheOuterOutlineInClosedLoops) {
  make("torus", "torus.ply", 2000);
  const std::string svg = drawn("torus.ply", "svg", {"--outline", "--view", "0,60"});
  const auto count = [&](const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + 1))
      ++found;
    return found;
  };
  EXPECT_EQ(count("<path"), 2u) << svg;
  EXPECT_EQ(count("Z\"/>"), 2u) << svg;
  const json drawing = edges_of("torus.ply", {"--outline", "--view", "0,60"});
  for (const json& edge : drawing["edges"])
    EXPECT_EQ(edge["outer"], true);
  EXPECT_GT(drawing["listed"], 50);
}

TEST_F(SilhouetteVerb, HidesWhatIsBehind) {
  folder.write("two.obj",
               "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 -0.5 -1\nv 3 -0.5 -1\nv 3 0.5 -1\nv 0 0.5 -1\n"
               "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n");
  const json all = edges_of("two.obj", {"--ortho", "--view", "0,0", "--all"});
  EXPECT_EQ(all["edges"].size(), 8u);
  for (const json& edge : all["edges"]) {
    const json v = edge["v"];
    const bool behind = v == json::array({4, 7});
    EXPECT_EQ(edge["visible"], !behind) << edge;
    const bool partly = v == json::array({4, 5}) || v == json::array({6, 7});
    ASSERT_EQ(edge.contains("visible_parts"), partly) << edge;
    if (!partly) continue;
    // x runs from 0 to 3 or back, hidden below 1.
    const bool back = v[0] == 6;
    EXPECT_NEAR(edge["visible_parts"][0][0].get<double>(), back ? 0.0 : 1.0 / 3, 1e-5);
    EXPECT_NEAR(edge["visible_parts"][0][1].get<double>(), back ? 2.0 / 3 : 1.0, 1e-5);
  }
  EXPECT_EQ(edges_of("two.obj", {"--ortho", "--view", "0,0", "--hidden"})["listed"], 3);
  EXPECT_EQ(edges_of("two.obj", {"--ortho", "--view", "0,0"})["listed"], 7);
}

TEST_F(SilhouetteVerb, DrawsTheClassesAskedFor) {
  make("cube", "cube.ply", 12);
  const auto classes = [&](const std::string& list, const std::string& model) {
    std::set<std::string> found;
    const json drawing = edges_of(model, {"--all", "--classes", list});
    for (const json& edge : drawing["edges"])
      found.insert(edge["class"]);
    return found;
  };
  folder.write("fan.obj", "v 0 0 0\nv 0 1 0\nv 1 0 0\nv -1 0 1\nv 0 0 2\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
  EXPECT_EQ(classes("silhouette,crease", "cube.ply"), (std::set<std::string>{"silhouette", "crease"}));
  EXPECT_EQ(classes("crease", "cube.ply"), (std::set<std::string>{"crease"}));
  EXPECT_EQ(classes("non-manifold,boundary", "fan.obj"), (std::set<std::string>{"boundary", "non-manifold"}));
  // An edge has one class: creases that are silhouettes from here are drawn as those.
  EXPECT_EQ(edges_of("cube.ply", {"--all", "--classes", "silhouette"})["edges"].size(), 6u);
  EXPECT_EQ(edges_of("cube.ply", {"--all", "--classes", "crease"})["edges"].size(), 6u);
  EXPECT_EQ(edges_of("cube.ply", {"--all", "--classes", "crease,silhouette"})["edges"].size(), 12u);
  EXPECT_EQ(edges_of("cube.ply", {"--all", "--classes", "crease", "--crease-angle", "91"})["edges"].size(), 0u);
}

TEST_F(SilhouetteVerb, WritesEveryFormat) {
  make("torus", "torus.ply", 800);
  EXPECT_TRUE(drawn("torus.ply", "svg").starts_with("<?xml"));
  EXPECT_TRUE(drawn("torus.ply", "dxf").ends_with("EOF\n"));
  EXPECT_TRUE(drawn("torus.ply", "ply").starts_with("ply\nformat binary"));
  EXPECT_TRUE(drawn("torus.ply", "ply", {"--ascii"}).starts_with("ply\nformat ascii"));
  EXPECT_NE(drawn("torus.ply", "obj").find("g silhouette-visible\nl "), std::string::npos);
  EXPECT_EQ(limn.json({"info", "drawing.ply"})["faces"], 0);
}

TEST_F(SilhouetteVerb, WritesTheSameBytesToStandardOutputAndForAnyNumberOfThreads) {
  make("knot", "knot.ply", 3000);
  for (const std::string format : {"svg", "dxf", "ply", "obj", "json"}) {
    const std::string file = drawn("knot.ply", format, {"--all", "--threads", "1"});
    const Outcome outcome =
        limn.run({"silhouette", "knot.ply", "-o", "-", "--format", format, "--all", "--threads", "3", "--quiet"});
    EXPECT_TRUE(outcome.out == file) << format;
    EXPECT_EQ(outcome.err, "");
  }
}

TEST_F(SilhouetteVerb, DrawsAtTheScaleAskedFor) {
  make("cube", "cube.ply", 12);
  const auto page = limn.json({"silhouette", "cube.ply", "-o", "c.svg", "--ortho", "--view", "0,0", "--scale", "25:1",
                               "--margin-mm", "5"})["page"];
  const double side = page["width_mm"].get<double>() - 10;
  const auto low = limn.json({"info", "cube.ply"})["bounds"]["low"][0].get<double>();
  EXPECT_NEAR(side, -2 * low * 25, 0.002);
  EXPECT_EQ(page["mm_per_unit"], 25);
  const auto larger = limn.json({"silhouette", "cube.ply", "-o", "c.svg", "--ortho", "--view", "0,0", "--scale", "25:1",
                                 "--width-mm", "297", "--height-mm", "210"})["page"];
  EXPECT_EQ(larger["width_mm"], 297);
  EXPECT_EQ(larger["height_mm"], 210);
  const Outcome outcome = limn.run(
      {"silhouette", "cube.ply", "-o", "c.svg", "--ortho", "--view", "0,0", "--scale", "500:1", "--width-mm", "297"});
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("choose a larger page or a smaller scale"), std::string::npos) << outcome.err;
}

TEST_F(SilhouetteVerb, OptionsChangeTheDrawing) {
  make("knot", "knot.ply", 2000);
  const std::string plain = drawn("knot.ply", "svg");
  for (const Arguments& options : std::vector<Arguments>{{"--all"},
                                                         {"--hidden"},
                                                         {"--outline"},
                                                         {"--classes", "crease", "--crease-angle", "10"},
                                                         {"--ortho"},
                                                         {"--view", "0,0"},
                                                         {"--eye", "0,0,4"},
                                                         {"--width-mm", "100"},
                                                         {"--height-mm", "100"},
                                                         {"--margin-mm", "0"},
                                                         {"--frame", "camera"},
                                                         {"--stroke-mm", "0.3"},
                                                         {"--tolerance-mm", "0.5"}}) {
    EXPECT_FALSE(drawn("knot.ply", "svg", options) == plain) << testing::PrintToString(options);
  }
  for (const Arguments& options : std::vector<Arguments>{{"--visible"},
                                                         {"--view", "30,20"},
                                                         {"--width-mm", "200", "--margin-mm", "10"},
                                                         {"--frame", "content", "--stroke-mm", "0.5"},
                                                         {"--classes", "boundary,silhouette"}}) {
    EXPECT_TRUE(drawn("knot.ply", "svg", options) == plain) << testing::PrintToString(options);
  }
}

TEST_F(SilhouetteVerb, SaysWhenThereIsNothingToDraw) {
  make("icosphere", "ball.ply", 320);
  for (const char* name : {"ball.svg", "ball.dxf", "ball.ply", "ball.obj", "ball.json"}) {
    const Outcome outcome =
        limn.run({"silhouette", "ball.ply", "-o", std::string("lines_of_") + name, "--classes", "boundary"});
    EXPECT_EQ(outcome.exit, 0);
    EXPECT_NE(outcome.err.find("nothing to draw"), std::string::npos) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder / (std::string("lines_of_") + name)));
  }
}

TEST_F(SilhouetteVerb, AnswersAMistypedClassWithTheNearest) {
  expect_refused({"-o", "a.svg", "--classes", "silhouette,creases"}, "--classes takes a list of silhouette, boundary");
  expect_refused({"-o", "a.svg", "--classes", "silhouette,creases"}, "did you mean 'crease'?");
  expect_refused({"-o", "a.svg", "--classes", "nonmanifold"}, "did you mean 'non-manifold'?");
  expect_refused({"-o", "a.svg", "--classes", "silhouette,"}, "--classes");
}

TEST_F(SilhouetteVerb, RefusesOptionsThatContradictEachOtherOrTheFormat) {
  expect_refused({"-o", "a.svg", "--visible", "--hidden"}, "exclude one another");
  expect_refused({"-o", "a.svg", "--hidden", "--outline"}, "--outline");
  expect_refused({"-o", "a.svg", "--all", "--outline"}, "--outline");
  expect_refused({"-o", "a.svg", "--classes", "crease", "--outline"}, "--outline");
  expect_refused({"-o", "a.svg", "--scale", "1:1"}, "add --ortho");
  expect_refused({"-o", "a.obj", "--width-mm", "100"}, "--width-mm is for pages, not for obj");
  expect_refused({"-o", "a.json", "--scale", "1:1", "--ortho"}, "--scale is for pages");
  expect_refused({"-o", "a.dxf", "--stroke-mm", "1"}, "--stroke-mm is for SVG");
  expect_refused({"-o", "a.svg", "--ascii"}, "--ascii is for PLY");
  expect_refused({"-o", "a.svg", "--width-mm", "20"}, "--margin-mm");
  expect_refused({"-o", "a.svg", "--eye", "0,0,1", "--view", "0,0"}, "--eye and --view");
  expect_refused({"-o", "a.png"}, ".svg, .dxf, .ply, .obj or .json");
  expect_refused({"-o", "-"}, "--format");
  expect_refused({"-o", "-", "--format", "svg", "--json"}, "standard output");
}

TEST_F(SilhouetteVerb, RefusesValuesOutOfRange) {
  for (const auto& [flag, values] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"--width-mm", {"0", "-1", "nan", "1e6", "x"}},
           {"--height-mm", {"0", "inf"}},
           {"--margin-mm", {"-1", "1e5"}},
           {"--stroke-mm", {"0", "101"}},
           {"--tolerance-mm", {"0", "2"}},
           {"--crease-angle", {"-1", "181"}},
           {"--scale", {"1", "1:0", "0:1", "1:2:3", ":", "1:", "a:b", "1e300:1e-300", "-1:1"}},
           {"--frame", {"page"}},
           {"--method", {"magic"}}}) {
    for (const std::string& value : values)
      expect_refused({"-o", "a.svg", flag, value}, flag);
  }
}

TEST_F(SilhouetteVerb, LeavesAnEarlierDrawingWhenItFails) {
  folder.write("drawing.svg", "precious");
  EXPECT_EQ(limn.run({"silhouette", "missing.ply", "-o", "drawing.svg"}).exit, 3);
  folder.write("empty.off", "OFF\n0 0 0\n");
  EXPECT_EQ(limn.run({"silhouette", "empty.off", "-o", "drawing.svg"}).exit, 4);
  EXPECT_EQ(slurp(folder / "drawing.svg"), "precious");
}

TEST_F(SilhouetteVerb, TitlesADrawingWithAFileNameThatIsNotUtf8) {
  const std::string name =
      "cu\xff"
      "be.ply";
  make("cube", name, 12);
  EXPECT_NE(drawn(name, "svg")
                .find("<title>cu\xef\xbf\xbd"
                      "be.ply</title>"),
            std::string::npos);
  EXPECT_EQ(edges_of(name)["input"],
            "cu\xef\xbf\xbd"
            "be.ply");
}

}  // namespace
}  // namespace limn::test

#endif
