// Lines in space, as OBJ and PLY: read back, every segment is there with its class.
#include "limn/drawing/line_files.h"

#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "limn/drawing/layer.h"
#include "limn/mesh/import.h"
#include "limn/mesh/shapes.h"

#include "drawing/lines.h"
#include "support/stable.h"

namespace limn::test {
namespace {

using Place = std::tuple<float, float, float>;
/// A segment and the layer it is of.
using Drawn = std::tuple<Place, Place, std::string>;

Place place(const Vec3& p) {
  return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
}

/// Denormals included, which std::stof refuses.
float number(const std::string& word) {
  return std::strtof(word.c_str(), nullptr);
}

std::multiset<Drawn> expected(const Polylines& lines) {
  std::multiset<Drawn> found;
  for (const Polyline& line : lines.lines) {
    const std::uint32_t count = line.end - line.begin;
    for (std::uint32_t i = 0; i < (line.closed ? count : count - 1); ++i) {
      const Place a = place(lines.points[line.begin + i]);
      const Place b = place(lines.points[line.begin + (i + 1) % count]);
      if (a != b) found.insert({a, b, layer_name(layer_of(line.line_class, line.visible))});
    }
  }
  return found;
}

std::multiset<Drawn> read_obj(const std::string& text) {
  std::multiset<Drawn> found;
  std::vector<Place> vertices;
  std::set<Place> distinct;
  std::string group;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      std::string x, y, z;
      words >> x >> y >> z;
      vertices.push_back(place({number(x), number(y), number(z)}));
      EXPECT_TRUE(distinct.insert(vertices.back()).second) << "repeated vertex";
    } else if (key == "g") {
      words >> group;
    } else if (key == "l") {
      std::size_t before = 0;
      for (std::size_t index = 0; words >> index; before = index) {
        EXPECT_TRUE(index >= 1 && index <= vertices.size());
        if (before > 0) found.insert({vertices.at(before - 1), vertices.at(index - 1), group});
      }
    } else {
      EXPECT_TRUE(key.empty() || key == "#") << line;
    }
  }
  return found;
}

template <class T>
T take(std::string_view& bytes) {
  T value{};
  EXPECT_GE(bytes.size(), sizeof(T));
  if (bytes.size() < sizeof(T)) return value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes.remove_prefix(sizeof(T));
  return value;
}

std::multiset<Drawn> read_ply(const std::string& text, bool ascii) {
  const std::size_t body = text.find("end_header\n") + 11;
  const auto count = [&](const std::string& element) {
    return std::stoul(text.substr(text.find("element " + element + " ") + 9 + element.size()));
  };
  std::string_view bytes = std::string_view(text).substr(body);
  std::istringstream words{std::string(bytes)};
  const auto real = [&] {
    std::string word;
    if (!ascii) return take<float>(bytes);
    words >> word;
    return number(word);
  };
  const auto integer = [&](bool byte) -> unsigned {
    unsigned value = 0;
    if (!ascii) return byte ? take<std::uint8_t>(bytes) : take<std::uint32_t>(bytes);
    words >> value;
    return value;
  };
  std::vector<Place> vertices;
  for (std::size_t i = 0; i < count("vertex"); ++i) {
    const float x = real(), y = real(), z = real();
    vertices.push_back(place({x, y, z}));
  }
  std::multiset<Drawn> found;
  for (std::size_t i = 0; i < count("edge"); ++i) {
    const unsigned a = integer(false), b = integer(false);
    const unsigned line_class = integer(true), visible = integer(true);
    integer(true);
    integer(false);
    found.insert(
        {vertices.at(a), vertices.at(b), layer_name(layer_of(static_cast<LineClass>(line_class), visible != 0))});
  }
  if (!ascii) {
    EXPECT_TRUE(bytes.empty());
  }
  return found;
}

void expect_kept(const Polylines& lines, const std::string& name) {
  const std::multiset<Drawn> all = expected(lines);
  EXPECT_TRUE(read_obj(obj_text(lines)) == all) << name;
  EXPECT_TRUE(read_ply(ply_text(lines, true), true) == all) << name;
  EXPECT_TRUE(read_ply(ply_text(lines, false), false) == all) << name;
}

TEST(LineFiles, KeepEverySegmentOfEveryAwkwardMesh) {
  for (const StableMesh& stable : awkward_meshes()) {
    Camera camera;
    camera.eye = {0.3f, 0.4f, 5};
    Polylines lines = outline_edges(stable.mesh, camera);
    bool visible = false;
    for (Polyline& line : lines.lines)
      line.visible = (visible = !visible);
    expect_kept(lines, stable.name);
  }
}

TEST(LineFiles, KeepLoopsClosed) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1f}}, LineClass::kCrease, true, true);
  add_line(lines, {{1, 0, 0}, {1, 0, 0}, {5, -0.0f, 0}}, LineClass::kBoundary, false);
  expect_kept(lines, "loop");
  EXPECT_NE(obj_text(lines).find("g crease-visible\nl 1 2 3 1\n"), std::string::npos) << obj_text(lines);
}

TEST(LineFiles, WithoutLinesAreFiles) {
  expect_kept({}, "nothing");
}

TEST(LineFiles, AreReadAsMeshesWithoutFaces) {
  const Mesh mesh = *make_shape(Shape::kTorus, {.faces = 500});
  const Polylines lines = outline_edges(mesh, fit_camera(mesh.positions, view_direction(0.5f, 0.5f)));
  for (const bool ascii : {false, true}) {
    const std::string text = ply_text(lines, ascii);
    const auto read = read_mesh(std::as_bytes(std::span<const char>(text)), MeshFormat::kPly, "lines.ply");
    ASSERT_TRUE(read) << format_error(read.error());
    EXPECT_EQ(read->mesh.faces.size(), 0u);
    EXPECT_GT(read->mesh.positions.size(), 10u);
  }
}

}  // namespace
}  // namespace limn::test
