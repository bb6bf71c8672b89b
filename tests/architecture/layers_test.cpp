#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "architecture/source_tree.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

/// What each module may include besides itself (docs/architecture.md). Dependencies point one way.
const std::map<std::string, std::set<std::string>>& layers() {
  static const std::map<std::string, std::set<std::string>> table = {
      {"base", {}},
      {"image", {"base"}},
      {"mesh", {"base"}},
      {"silhouette", {"mesh", "base"}},
      {"refine", {"silhouette", "mesh", "base"}},
      {"fit", {"refine", "silhouette", "mesh", "base"}},
      {"hull", {"mesh", "base"}},
      {"bake", {"mesh", "image", "base"}},
      {"asset", {"hull", "bake", "silhouette", "mesh", "image", "base"}},
      {"drawing", {"silhouette", "mesh", "base"}},
      {"compare", {"mesh", "base"}},
      {"gl", {"base"}},
      {"render",
       {"gl", "compare", "drawing", "asset", "bake", "hull", "fit", "refine", "silhouette", "mesh", "image", "base"}},
  };
  return table;
}

bool is_graphics_module(const std::string& module) {
  return module == "gl" || module == "render";
}

/// Headers of OpenGL, windows and user interfaces, which core must do without.
bool is_graphics_header(const std::string& target) {
  for (const std::string_view start : {"GL/", "GLES", "EGL/", "KHR/", "epoxy/", "GLFW/", "X11/", "SDL", "imgui"}) {
    if (target.starts_with(start)) return true;
  }
  return false;
}

struct Include {
  std::string target;
  bool quoted = false;
};

/// What a public header may show its users: the standard library, what limn's own types are made of, and each other.
bool is_public_dependency(const Include& include, const std::set<std::string>& public_headers) {
  const std::string& target = include.target;
  if (target.starts_with("limn/")) return public_headers.contains(target.substr(5));
  const bool standard = target.find_first_of("/.") == std::string::npos;
  return standard || target.starts_with("glm/") || target == "tl/expected.hpp";
}

std::optional<Include> parse_include(std::string_view line) {
  const auto skip_blanks = [&line] {
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t'))
      line.remove_prefix(1);
  };
  skip_blanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(7);
  skip_blanks();
  if (line.empty() || (line.front() != '"' && line.front() != '<')) return std::nullopt;
  const bool quoted = line.front() == '"';
  const std::size_t end = line.find(quoted ? '"' : '>', 1);
  if (end == std::string_view::npos) return std::nullopt;
  return Include{std::string(line.substr(1, end - 1)), quoted};
}

/// The second part of "limn/mesh/topology.h".
std::string module_of(const std::string& target) {
  const std::size_t start = target.find('/') + 1;
  return target.substr(start, target.find('/', start) - start);
}

/// Why a file of src/limn/MODULE must not include this; nothing when it may.
std::optional<std::string> objection(const std::string& module, const Include& include) {
  const std::string& target = include.target;
  if (include.quoted && !target.starts_with("limn/")) return "\"" + target + "\" is not written from the root, limn/…";
  if (target.starts_with("limn/")) {
    const std::string other = module_of(target);
    if (other == module || layers().at(module).contains(other)) return std::nullopt;
    return module + " must not depend on " + other + " (" + target + ")";
  }
  if (!is_graphics_module(module) && is_graphics_header(target)) return "core must not include <" + target + ">";
  return std::nullopt;
}

/// The list of ROOT/src/limn/public_headers.txt.
std::set<std::string> public_headers(const fs::path& root) {
  std::set<std::string> headers;
  for (const std::string& line : lines_of(root / "src" / "limn" / "public_headers.txt")) {
    if (!line.starts_with('#')) headers.insert(line);
  }
  return headers;
}

/// Reads every #include under ROOT/src/limn.
Problems check_layers(const fs::path& root) {
  const std::set<std::string> interface = public_headers(root);
  Problems problems;
  for (const std::string& header : interface) {
    if (!fs::exists(root / "src" / "limn" / header)) problems.push_back(problem(header, 1, "public, but not there"));
  }
  for (const fs::path& file : files_of(root / "src" / "limn")) {
    if (!has_extension(file, {".h", ".cpp"})) continue;
    const std::string module = file.begin()->string();
    if (!layers().contains(module)) {
      problems.push_back(problem(file, 1, "module " + module + " is not in the table of layers"));
      continue;
    }
    const bool is_public = interface.contains(file.generic_string());
    const std::vector<std::string> lines = lines_of(root / "src" / "limn" / file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::optional<Include> include = parse_include(lines[i]);
      if (!include) continue;
      if (const auto cause = objection(module, *include)) problems.push_back(problem(file, i + 1, *cause));
      if (is_public && !is_public_dependency(*include, interface)) {
        problems.push_back(problem(file, i + 1, "a public header must not show its users " + include->target));
      }
    }
  }
  return problems;
}

TEST(Layers, HoldInTheSourceTree) {
  const Problems problems = check_layers(LIMN_SOURCE_DIR);
  EXPECT_TRUE(problems.empty()) << joined(problems);
}

TEST(Layers, OfTheTableHaveNoCycle) {
  for (const auto& [module, below] : layers()) {
    for (const std::string& other : below) {
      ASSERT_TRUE(layers().contains(other)) << other;
      EXPECT_FALSE(layers().at(other).contains(module)) << module << " and " << other;
      for (const std::string& deeper : layers().at(other))
        EXPECT_TRUE(below.contains(deeper)) << module << deeper;
    }
  }
}

TEST(Layers, AcceptWhatTheTableAllows) {
  const TempFolder folder;
  folder.write("src/limn/public_headers.txt", "# a comment\nbase/vec.h\nmesh/good.h\n");
  folder.write("src/limn/base/vec.h", "");
  folder.write("src/limn/mesh/good.h", "#include <vector>\n#include <glm/vec3.hpp>\n#include \"limn/base/vec.h\"\n");
  folder.write("src/limn/mesh/good.cpp", "#include <tiny_gltf.h>\n#include \"limn/mesh/good.h\"\n");
  folder.write("src/limn/mesh/own.h", "#include <tiny_gltf.h>\n");
  folder.write("src/limn/render/good.cpp", "#include <epoxy/gl.h>\n#include \"limn/refine/refine.h\"\n");
  EXPECT_EQ(check_layers(folder.path()), Problems{});
}

TEST(Layers, FindEverySeededViolation) {
  const TempFolder folder;
  folder.write("src/limn/public_headers.txt", "mesh/heavy.h\nmesh/shows_own.h\nmesh/gone.h\n");
  folder.write("src/limn/mesh/shows_own.h", "#include \"limn/mesh/own.h\"\n");
  folder.write("src/limn/mesh/own.h", "");
  folder.write("src/limn/mesh/upward.h", "#pragma once\n#include \"limn/refine/refine.h\"\n");
  folder.write("src/limn/mesh/upward_in_brackets.cpp", "#  include <limn/silhouette/eye.h>\n");
  folder.write("src/limn/compare/draws.cpp", "#include <EGL/egl.h>\n");
  folder.write("src/limn/gl/knows_meshes.cpp", "#include \"limn/mesh/mesh.h\"\n");
  folder.write("src/limn/mesh/heavy.h", "#include <tiny_gltf.h>\n#include <nlohmann/json.hpp>\n");
  folder.write("src/limn/mesh/relative.cpp", "#include \"../refine/refine.h\"\n");
  folder.write("src/limn/extra/unknown.cpp", "int x;\n");
  EXPECT_EQ(check_layers(folder.path()).size(), 10u) << joined(check_layers(folder.path()));
}

}  // namespace
}  // namespace limn::test
