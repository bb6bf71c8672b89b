#include "limn/hull/suitability.h"

#include <gtest/gtest.h>

#include "limn/hull/shell.h"

#include "support/stable.h"

namespace limn::test {
namespace {

TEST(SolidSuitability, SaysWhatMakeShellSaysOnTheWholeStable) {
  for (const StableMesh& entry : awkward_meshes()) {
    const Result<Shell> shell = make_shell(entry.mesh);
    const std::vector<Suitability> all = solid_suitability(entry.mesh);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].technique, "hull");
    EXPECT_EQ(all[1].technique, "clip");
    for (const Suitability& one : all) {
      EXPECT_EQ(one.can_run, shell.has_value()) << entry.name;
      EXPECT_EQ(one.reasons, shell ? shell->notes : std::vector{format_error(shell.error())}) << entry.name;
    }
  }
}

}  // namespace
}  // namespace limn::test
