#include <algorithm>
#include <cctype>
#include <gtest/gtest.h>
#include <regex>
#include <string>
#include <vector>

#include "architecture/source_tree.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

constexpr std::size_t kLongestFile = 700;

bool is_code(const fs::path& file) {
  return has_extension(file, {".h", ".cpp", ".glsl", ".cmake"}) || file.filename() == "CMakeLists.txt" ||
         lies_in(file, {"scripts", ".ci"});
}

bool is_document(const fs::path& file) {
  return file.extension() == ".md";
}

Problems check_lengths(const fs::path& root) {
  Problems problems;
  for (const fs::path& file : files_of(root)) {
    if (!is_code(file)) continue;
    const std::size_t length = lines_of(root / file).size();
    if (length > kLongestFile) problems.push_back(problem(file, length, "too long: one idea a file"));
  }
  return problems;
}

bool is_snake_case(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_' || c == '.';
  });
}

Problems check_names(const fs::path& root) {
  Problems problems;
  for (const fs::path& file : files_of(root)) {
    if (!has_extension(file, {".h", ".cpp", ".glsl"})) continue;
    for (const fs::path& part : file) {
      if (!is_snake_case(part.string())) problems.push_back(problem(file, 1, part.string() + " is not snake_case"));
    }
  }
  return problems;
}

/// The target of a link as a file beside `document`; empty for one that leads elsewhere.
fs::path linked_file(const fs::path& document, std::string target) {
  const bool elsewhere = target.find("://") != std::string::npos || target.starts_with("mailto:");
  target = target.substr(0, target.find('#'));
  return elsewhere || target.empty() ? fs::path() : document.parent_path() / target;
}

void check_links_of_line(const fs::path& root, const fs::path& file, std::size_t number, const std::string& line,
                         Problems& problems) {
  // A target has a dot or a slash; brackets without one are a formula.
  static const std::regex markdown_link(R"(\]\(([^)\s]*[./][^)\s]*)[^)]*\))");
  static const std::regex html_source(R"re((?:src|href)="([^"]+)")re");
  for (const std::regex* pattern : {&markdown_link, &html_source}) {
    for (std::sregex_iterator it(line.begin(), line.end(), *pattern), end; it != end; ++it) {
      const fs::path target = linked_file(root / file, (*it)[1]);
      if (target.empty() || fs::exists(target)) continue;
      problems.push_back(problem(file, number, (*it)[1].str() + " is missing"));
    }
  }
}

/// Every relative link and picture of a document leads to a file. Blocks of code have no links.
Problems check_links(const fs::path& root) {
  Problems problems;
  for (const fs::path& file : files_of(root)) {
    if (!is_document(file)) continue;
    const std::vector<std::string> lines = lines_of(root / file);
    bool in_code = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].starts_with("```")) in_code = !in_code;
      if (!in_code) check_links_of_line(root, file, i + 1, lines[i], problems);
    }
  }
  return problems;
}

/// Every page that a comment or a message names as docs/PAGE.md exists.
Problems check_named_pages(const fs::path& root) {
  static const std::regex page(R"(\bdocs/[A-Za-z0-9_/-]+\.md)");
  Problems problems;
  for (const fs::path& file : files_of(root)) {
    if (!is_code(file) || lies_in(file, {"tests"})) continue;
    const std::vector<std::string> lines = lines_of(root / file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::sregex_iterator it(lines[i].begin(), lines[i].end(), page), end; it != end; ++it) {
        if (!fs::exists(root / it->str())) problems.push_back(problem(file, i + 1, it->str() + " is missing"));
      }
    }
  }
  return problems;
}

/// No file names a folder of the machine it was written on.
Problems check_machine_paths(const fs::path& root) {
  // Written apart so that this file passes its own test.
  static const std::regex machine_path(
      "(^|[^A-Za-z0-9_.}-])/(home|root|wo"
      "rk|Users|tm"
      "p)/");
  Problems problems;
  for (const fs::path& file : files_of(root)) {
    if (!is_code(file) && !is_document(file) && file.filename() != "Makefile") continue;
    const std::vector<std::string> lines = lines_of(root / file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (std::regex_search(lines[i], machine_path))
        problems.push_back(problem(file, i + 1, "a path of one machine: " + lines[i]));
    }
  }
  return problems;
}

TEST(Tree, HasNoFileThatIsTooLong) {
  const Problems problems = check_lengths(LIMN_SOURCE_DIR);
  EXPECT_TRUE(problems.empty()) << joined(problems);
}

TEST(Tree, NamesItsFilesInSnakeCase) {
  const Problems problems = check_names(LIMN_SOURCE_DIR);
  EXPECT_TRUE(problems.empty()) << joined(problems);
}

TEST(Tree, HasNoDeadLinkInItsDocuments) {
  const Problems problems = check_links(LIMN_SOURCE_DIR);
  EXPECT_TRUE(problems.empty()) << joined(problems);
}

TEST(Tree, HasEveryPageThatCommentsName) {
  const Problems problems = check_named_pages(LIMN_SOURCE_DIR);
  EXPECT_TRUE(problems.empty()) << joined(problems);
}

TEST(Tree, NamesNoFolderOfOneMachine) {
  const Problems problems = check_machine_paths(LIMN_SOURCE_DIR);
  EXPECT_TRUE(problems.empty()) << joined(problems);
}

TEST(TreeChecks, FindEverySeededFault) {
  const TempFolder folder;
  std::string long_text;
  for (std::size_t i = 0; i <= kLongestFile; ++i)
    long_text += "int x;\n";
  folder.write("src/limn/mesh/long.cpp", long_text);
  folder.write("src/limn/mesh/CamelCase.h", "");
  folder.write("src/limn/mesh/names_a_page.h", "// see docs/missing.md and docs/there.md\n");
  folder.write("docs/there.md",
               "[gone](gone.md) ![gone](a/gone.png \"title\") [web](https://example.org/x) [self](#part)\n");
  folder.write("README.md",
               "<img src=\"docs/gone.png\"> [there](docs/there.md#part)\n```cpp\n[&](int) {}\n```\nopen /ho"
               "me/me/model.obj\n");
  EXPECT_EQ(check_lengths(folder.path()).size(), 1u);
  EXPECT_EQ(check_names(folder.path()).size(), 1u);
  EXPECT_EQ(check_named_pages(folder.path()).size(), 1u);
  EXPECT_EQ(check_links(folder.path()).size(), 3u) << joined(check_links(folder.path()));
  EXPECT_EQ(check_machine_paths(folder.path()).size(), 1u);
}

TEST(TreeChecks, LeaveBuildTreesAlone) {
  const TempFolder folder;
  folder.write("build/release/Bad.h", "");
  folder.write("other-tree/CMakeCache.txt", "");
  folder.write("other-tree/Bad.h", "");
  EXPECT_EQ(check_names(folder.path()), Problems{});
}

}  // namespace
}  // namespace limn::test
