#include "limn/mesh/validate.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "limn/base/parallel.h"
#include "limn/mesh/shapes.h"

#include "support/checks.h"
#include "support/stable.h"

namespace limn {
namespace {

using test::StableMesh;

MeshReport report_of(const Mesh& mesh) {
  return validate(mesh, build_topology(mesh));
}

const StableMesh& stable_mesh(std::string_view name) {
  static const std::vector<StableMesh> all = test::awkward_meshes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const StableMesh& entry) { return entry.name == name; });
  EXPECT_NE(found, all.end()) << name;
  return found == all.end() ? all.front() : *found;
}

MeshReport report_of(std::string_view name) {
  return report_of(stable_mesh(name).mesh);
}

const Suitability& technique(const std::vector<Suitability>& all, std::string_view name) {
  return *std::find_if(all.begin(), all.end(), [&](const Suitability& one) { return one.technique == name; });
}

bool mentions(const Suitability& one, std::string_view text) {
  return std::any_of(one.reasons.begin(), one.reasons.end(),
                     [&](const std::string& reason) { return reason.find(text) != std::string::npos; });
}

/// A slow count of fans and components: neighbours are found by trying every pair of faces.
struct SlowCounts {
  std::size_t non_manifold_vertices = 0, components = 0, duplicates = 0;
};

std::size_t count_groups(std::size_t count, const std::function<bool(std::size_t, std::size_t)>& touch) {
  std::vector<bool> seen(count, false);
  std::size_t groups = 0;
  for (std::size_t first = 0; first < count; ++first) {
    if (seen[first]) continue;
    ++groups;
    std::vector<std::size_t> open{first};
    seen[first] = true;
    while (!open.empty()) {
      const std::size_t one = open.back();
      open.pop_back();
      for (std::size_t other = 0; other < count; ++other) {
        if (!seen[other] && touch(one, other)) {
          seen[other] = true;
          open.push_back(other);
        }
      }
    }
  }
  return groups;
}

SlowCounts count_slowly(const Topology& topology) {
  std::vector<std::set<VertexId>> faces;
  for (const Triangle& t : topology.faces) {
    const std::set<VertexId> corners(t.begin(), t.end());
    if (corners.size() == 3) faces.push_back(corners);
  }
  const auto shared = [&](std::size_t a, std::size_t b) {
    std::vector<VertexId> both;
    std::set_intersection(faces[a].begin(), faces[a].end(), faces[b].begin(), faces[b].end(), std::back_inserter(both));
    return both;
  };
  SlowCounts counts;
  counts.components =
      count_groups(faces.size(), [&](std::size_t a, std::size_t b) { return shared(a, b).size() >= 2; });
  counts.duplicates = faces.size() - std::set(faces.begin(), faces.end()).size();
  std::map<VertexId, std::vector<std::size_t>> around;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    for (const VertexId v : faces[face])
      around[v].push_back(face);
  }
  for (const auto& [v, fan] : around) {
    const std::size_t fans = count_groups(fan.size(), [&, vertex = v, &ring = fan](std::size_t a, std::size_t b) {
      const std::vector<VertexId> both = shared(ring[a], ring[b]);
      return both.size() >= 2 && std::count(both.begin(), both.end(), vertex) == 1;
    });
    counts.non_manifold_vertices += fans > 1;
  }
  return counts;
}

TEST(Validate, CountsEqualTheSlowCountsOnTheWholeStable) {
  for (const StableMesh& entry : test::awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    const Topology topology = build_topology(entry.mesh);
    const MeshReport report = validate(entry.mesh, topology);
    const test::EdgeCounts edges = test::count_edges(entry.mesh);
    EXPECT_EQ(report.edges, edges.edges);
    EXPECT_EQ(report.boundary_edges, edges.boundary);
    EXPECT_EQ(report.inconsistent_edges, edges.inconsistent);
    EXPECT_EQ(report.non_manifold_edges, edges.non_manifold);
    EXPECT_EQ(report.welded_vertices, test::count_used_positions(entry.mesh));
    EXPECT_EQ(report.closed, edges.edges > 0 && edges.manifold == edges.edges);
    const SlowCounts slow = count_slowly(topology);
    EXPECT_EQ(report.non_manifold_vertices, slow.non_manifold_vertices);
    EXPECT_EQ(report.components, slow.components);
    EXPECT_EQ(report.duplicate_faces, slow.duplicates);
  }
}

TEST(Validate, EulerCharacteristicTellsTheGenus) {
  const std::map<std::string_view, long> expected{{"sphere with a texture seam", 2},
                                                  {"cube split at normals", 2},
                                                  {"torus", 0},
                                                  {"coarse knot", 0},
                                                  {"three holes", -4},
                                                  {"sheet", 1},
                                                  {"Moebius band", 0},
                                                  {"Klein bottle", 0},
                                                  {"soup cube", 2},
                                                  {"two components", 4},
                                                  {"degenerate faces", 2},
                                                  {"stray vertices", 2}};
  for (const auto& [name, euler] : expected)
    EXPECT_EQ(report_of(name).euler_characteristic, euler) << name;
}

TEST(Validate, BoundaryLoopsAreCounted) {
  const std::map<std::string_view, std::size_t> expected{{"sheet", 1},        {"Moebius band", 1}, {"bow tie", 2},
                                                         {"one triangle", 1}, {"torus", 0},        {"no vertices", 0}};
  for (const auto& [name, loops] : expected)
    EXPECT_EQ(report_of(name).boundary_loops, loops) << name;
  Mesh punctured = stable_mesh("sphere with a texture seam").mesh;
  punctured.normals = {};
  punctured.uvs = {};
  punctured.faces.erase(punctured.faces.begin() + 100);
  punctured.faces.erase(punctured.faces.begin());
  EXPECT_EQ(report_of(punctured).boundary_loops, 2u);
}

TEST(Validate, NonManifoldVerticesAreThoseWithSeveralFans) {
  EXPECT_EQ(report_of("two tetrahedra sharing a vertex").non_manifold_vertices, 1u);
  EXPECT_EQ(report_of("bow tie").non_manifold_vertices, 1u);
  EXPECT_EQ(report_of("two tetrahedra sharing an edge").non_manifold_vertices, 0u);
  EXPECT_EQ(report_of("high valence").non_manifold_vertices, 0u);
}

TEST(Validate, FacesWithoutAreaAreToldFromDegenerateOnes) {
  EXPECT_EQ(report_of("degenerate faces").degenerate_faces, 3u);
  EXPECT_EQ(report_of("degenerate faces").zero_area_faces, 0u);
  EXPECT_EQ(report_of("collinear face").zero_area_faces, 1u);
  EXPECT_EQ(report_of("collinear face").degenerate_faces, 0u);
  EXPECT_EQ(report_of("needles").zero_area_faces, 0u);
  EXPECT_EQ(report_of("subnormal coordinates").zero_area_faces, 0u);
  EXPECT_EQ(report_of("coordinates of 1e30").zero_area_faces, 0u);
}

TEST(Validate, DuplicatesCountInAnyOrder) {
  EXPECT_EQ(report_of("duplicate faces").duplicate_faces, 3u);
}

TEST(Validate, StrayVerticesAreCountedAndStayOutOfTheBox) {
  const MeshReport report = report_of("stray vertices");
  EXPECT_EQ(report.vertices, 6u);
  EXPECT_EQ(report.welded_vertices, 4u);
  EXPECT_EQ(report.unused_vertices, 2u);
  EXPECT_EQ(report.bounds.high, Vec3(1, 1, 1));
  EXPECT_EQ(report.bounds.low, Vec3(0, 0, 0));
}

TEST(Validate, VolumeAndAreaHoldAtEveryScaleAndFarFromTheOrigin) {
  const MeshReport cube = report_of("soup cube");
  EXPECT_DOUBLE_EQ(cube.volume, 8);
  EXPECT_DOUBLE_EQ(cube.area, 24);
  EXPECT_DOUBLE_EQ(report_of("far from the origin").volume, 8);
  EXPECT_DOUBLE_EQ(report_of("inside out").volume, -8);
  EXPECT_DOUBLE_EQ(report_of("shell with a cavity").volume, 7);
  const MeshReport huge = report_of("coordinates of 1e30"), tiny = report_of("coordinates of 1e-30");
  EXPECT_NEAR(huge.volume * 1e-90, tiny.volume * 1e90, 1e-5);
  EXPECT_NEAR(huge.area * 1e-60, tiny.area * 1e60, 1e-5);
  EXPECT_GT(report_of("subnormal coordinates").volume, 0);
}

TEST(Validate, SameReportForAnyNumberOfThreads) {
  for (const StableMesh& entry : test::awkward_meshes()) {
    const auto with = [&](int threads) {
      const ThreadLimit limit(threads);
      return report_of(entry.mesh);
    };
    const MeshReport one = with(1), two = with(2);
    EXPECT_EQ(one.volume, two.volume) << entry.name;
    EXPECT_EQ(one.area, two.area) << entry.name;
    EXPECT_EQ(one.components, two.components) << entry.name;
  }
}

TEST(Suitability, SolidsHaveSilhouettesAndRefine) {
  for (const std::string_view name : {"three holes", "soup cube", "shell with a cavity", "coordinates of 1e-30"}) {
    for (const Suitability& one : suitability(report_of(name)))
      EXPECT_TRUE(one.can_run) << name << ": " << one.technique;
  }
}

TEST(Suitability, OpenSheetsHaveSilhouettesAndRefine) {
  const auto all = suitability(report_of("sheet"));
  EXPECT_TRUE(technique(all, "silhouette").can_run);
  EXPECT_TRUE(technique(all, "refine").can_run);
}

TEST(Suitability, NothingRunsWithoutAFaceOfSomeArea) {
  for (const std::string_view name : {"no vertices", "vertices without faces", "only a degenerate face"}) {
    for (const Suitability& one : suitability(report_of(name))) {
      EXPECT_FALSE(one.can_run) << name << ": " << one.technique;
      EXPECT_EQ(one.reasons.size(), 1u) << name;
    }
  }
}

TEST(Suitability, RefineSaysWhatToExpect) {
  const auto refine = [](std::string_view name) { return technique(suitability(report_of(name)), "refine"); };
  EXPECT_TRUE(mentions(refine("three fins on an edge"), "stay straight"));
  EXPECT_TRUE(mentions(refine("flipped face"), "--repair"));
  EXPECT_TRUE(mentions(refine("soup cube"), "no normals"));
  EXPECT_TRUE(refine("torus").reasons.empty());
}

}  // namespace
}  // namespace limn
