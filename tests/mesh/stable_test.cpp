#include "support/stable.h"

#include <gtest/gtest.h>
#include <set>

#include "support/checks.h"

namespace limn::test {
namespace {

TEST(Stable, MeshesAreWellFormedAndNamedOnce) {
  std::set<std::string> names;
  for (const StableMesh& entry : awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    expect_well_formed(entry.mesh);
    EXPECT_TRUE(names.insert(entry.name).second);
  }
}

TEST(Stable, WhatIsSaidOfEdgesIsTrue) {
  for (const StableMesh& entry : awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    const EdgeCounts counts = count_edges(entry.mesh);
    EXPECT_EQ(entry.manifold, counts.non_manifold == 0);
    EXPECT_EQ(entry.closed, counts.edges > 0 && counts.manifold + counts.inconsistent == counts.edges);
  }
}

TEST(Stable, OneSidedSurfacesHaveNoConsistentWinding) {
  for (const StableMesh& entry : awkward_meshes()) {
    if (entry.name != "Moebius band" && entry.name != "Klein bottle") continue;
    EXPECT_GT(count_edges(entry.mesh).inconsistent, 0u) << entry.name;
  }
}

}  // namespace
}  // namespace limn::test
