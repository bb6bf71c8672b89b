#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "architecture/source_tree.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

/// The first fenced block of a document that is marked as this language; empty when there is none.
std::string code_block(const fs::path& document, const std::string& language) {
  std::string block;
  bool inside = false;
  for (const std::string& line : lines_of(document)) {
    if (inside && line == "```") return block;
    if (inside) block += line + '\n';
    if (line == "```" + language) inside = true;
  }
  return {};
}

/// A source without the comment it starts with.
std::string without_head_comment(const fs::path& source) {
  std::string text;
  bool in_head = true;
  for (const std::string& line : lines_of(source)) {
    in_head = in_head && line.starts_with("//");
    if (!in_head) text += line + '\n';
  }
  return text;
}

TEST(Readme, ShowsTheFirstExampleAsItIsCompiled) {
  const fs::path root = LIMN_SOURCE_DIR;
  const std::string shown = code_block(root / "README.md", "cpp");
  ASSERT_FALSE(shown.empty());
  EXPECT_EQ(shown, without_head_comment(root / "examples" / "01_refine_a_mesh.cpp"));
}

TEST(Readme, StartsWithTheTwoCommands) {
  const std::string commands = code_block(fs::path(LIMN_SOURCE_DIR) / "README.md", "sh");
  EXPECT_NE(commands.find("make demo"), std::string::npos);
  EXPECT_NE(commands.find("make test"), std::string::npos);
}

TEST(ReadmeChecks, NoticeADifference) {
  const TempFolder folder;
  const fs::path readme = folder.write("README.md", "text\n```sh\nmake\n```\n```cpp\nint main() {}\n```\n");
  const fs::path same = folder.write("same.cpp", "// What it does.\nint main() {}\n");
  const fs::path other = folder.write("other.cpp", "// What it does.\nint main() { return 1; }\n");
  EXPECT_EQ(code_block(readme, "cpp"), without_head_comment(same));
  EXPECT_NE(code_block(readme, "cpp"), without_head_comment(other));
  EXPECT_EQ(code_block(readme, "python"), "");
}

}  // namespace
}  // namespace limn::test
