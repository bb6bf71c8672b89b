// The list of drawn edges: each once, with its vertices, class, and what of it is seen.
#include "limn/drawing/edge_list.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "drawing/lines.h"
#include "support/stable.h"

namespace limn::test {
namespace {

using nlohmann::json;

/// One triangle; edge 0 joins vertices 0 and 1.
Topology triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
  mesh.faces = {{0, 1, 2}};
  return build_topology(mesh);
}

EdgeInterval part(float begin, float end, bool visible, bool outer = false) {
  return {0, begin, end, LineClass::kBoundary, visible, outer};
}

std::string written(const std::vector<EdgeInterval>& intervals) {
  return edges_json(drawn_edges(intervals), triangle());
}

TEST(EdgeList, NamesEdgesByTheMeshsOwnVertices) {
  for (const StableMesh& stable : awkward_meshes()) {
    const Topology topology = build_topology(stable.mesh);
    std::vector<EdgeInterval> intervals;
    for (EdgeId edge = 0; edge < topology.edge_count(); ++edge)
      intervals.push_back({edge, 0, 1, kLineClasses[edge % 4], edge % 3 == 0, false});
    const json edges = json::parse(edges_json(drawn_edges(intervals), topology));
    ASSERT_EQ(edges.size(), topology.edge_count()) << stable.name;
    for (EdgeId edge = 0; edge < edges.size(); ++edge) {
      const Edge& expected = topology.edges[edge];
      EXPECT_EQ(edges[edge]["v"], json::array({expected.v[0], expected.v[1]})) << stable.name;
      EXPECT_EQ(edges[edge]["class"], line_class_name(kLineClasses[edge % 4]));
      EXPECT_EQ(edges[edge]["visible"], edge % 3 == 0);
      EXPECT_FALSE(edges[edge].contains("visible_parts")) << stable.name;
    }
  }
}

TEST(EdgeList, SaysWhichPartsAreSeen) {
  EXPECT_EQ(written({part(0, 0.25f, true), part(0.25f, 0.75f, false), part(0.75f, 1, true)}),
            "[\n{\"v\":[0,1],\"class\":\"boundary\",\"visible\":true,\"visible_parts\":[[0,0.25],[0.75,1]]}\n]");
}

TEST(EdgeList, JoinsPartsThatTouch) {
  EXPECT_EQ(written({part(0, 0.3f, true, true), part(0.3f, 1, true)}),
            "[\n{\"v\":[0,1],\"class\":\"boundary\",\"visible\":true,\"outer\":true}\n]");
  EXPECT_EQ(written({part(0, 0.25f, true, true), part(0.25f, 0.5f, true), part(0.5f, 1, false)}),
            "[\n{\"v\":[0,1],\"class\":\"boundary\",\"visible\":true,\"visible_parts\":[[0,0.5]],\"outer\":true}\n]");
}

TEST(EdgeList, OfHiddenEdgesSaysSo) {
  EXPECT_EQ(written({part(0, 0.5f, false), part(0.5f, 1, false)}),
            "[\n{\"v\":[0,1],\"class\":\"boundary\",\"visible\":false}\n]");
}

TEST(EdgeList, OfNothingIsEmpty) {
  EXPECT_EQ(edges_json({}, {}), "[]");
}

}  // namespace
}  // namespace limn::test
