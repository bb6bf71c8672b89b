#include "limn/drawing/line_files.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "limn/drawing/layer.h"
#include "limn/mesh/formats/text.h"

namespace limn {
namespace {

using formats::append_number;
using formats::append_position;

static_assert(std::endian::native == std::endian::little, "binary PLY is written as it lies in memory");

/// Distinct points in the order of their first use, and for each point of the lines which of them it is.
struct Vertices {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> of_point;
};

Vertices distinct(const std::vector<Vec3>& points) {
  const auto before = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (before(points[a], points[b])) return true;
    return !before(points[b], points[a]) && a < b;
  });
  // Each point's lowest equal, which comes first among its equals.
  std::vector<std::uint32_t> lowest(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool equal = i > 0 && !before(points[order[i - 1]], points[order[i]]);
    lowest[order[i]] = equal ? lowest[order[i - 1]] : order[i];
  }
  Vertices vertices;
  vertices.of_point.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (lowest[i] == i) {
      vertices.of_point[i] = static_cast<std::uint32_t>(vertices.positions.size());
      vertices.positions.push_back(points[i]);
    } else {
      vertices.of_point[i] = vertices.of_point[lowest[i]];
    }
  }
  return vertices;
}

/// Calls body(from, to) with the points of every segment of a line that has a length.
template <class Body>
void for_each_segment(const Polyline& line, const Vertices& vertices, const Body& body) {
  const std::uint32_t count = line.end - line.begin;
  const std::uint32_t segments = line.closed ? count : count - 1;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t from = vertices.of_point[line.begin + i];
    const std::uint32_t to = vertices.of_point[line.begin + (i + 1) % count];
    if (from != to) body(from, to);
  }
}

void append_obj_line(std::string& text, const Polyline& line, const Vertices& vertices) {
  bool begun = false;
  for_each_segment(line, vertices, [&](std::uint32_t from, std::uint32_t to) {
    if (!begun) {
      text += "l ";
      append_number(text, std::uint64_t{from} + 1);
      begun = true;
    }
    text += ' ';
    append_number(text, std::uint64_t{to} + 1);
  });
  if (begun) text += '\n';
}

struct PlyEdge {
  std::uint32_t from;
  std::uint32_t to;
  std::uint8_t line_class;
  std::uint8_t visible;
  std::uint8_t outer;
  std::uint32_t line;
};

std::vector<PlyEdge> ply_edges(const Polylines& lines, const Vertices& vertices) {
  std::vector<PlyEdge> edges;
  edges.reserve(lines.points.size());
  for (std::uint32_t number = 0; number < lines.lines.size(); ++number) {
    const Polyline& line = lines.lines[number];
    for_each_segment(line, vertices, [&](std::uint32_t from, std::uint32_t to) {
      edges.push_back({from, to, static_cast<std::uint8_t>(line.line_class), std::uint8_t{line.visible},
                       std::uint8_t{line.outer}, number});
    });
  }
  return edges;
}

template <class T>
void append_bytes(std::string& text, const T& value) {
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_ascii(std::string& text, const Vertices& vertices, const std::vector<PlyEdge>& edges) {
  for (const Vec3& p : vertices.positions) {
    append_position(text, p);
  }
  for (const PlyEdge& edge : edges) {
    text +=
        fmt::format("{} {} {} {} {} {}\n", edge.from, edge.to, edge.line_class, edge.visible, edge.outer, edge.line);
  }
}

void append_binary(std::string& text, const Vertices& vertices, const std::vector<PlyEdge>& edges) {
  for (const Vec3& p : vertices.positions) {
    append_bytes(text, p.x);
    append_bytes(text, p.y);
    append_bytes(text, p.z);
  }
  for (const PlyEdge& edge : edges) {
    append_bytes(text, edge.from);
    append_bytes(text, edge.to);
    append_bytes(text, edge.line_class);
    append_bytes(text, edge.visible);
    append_bytes(text, edge.outer);
    append_bytes(text, edge.line);
  }
}

}  // namespace

std::string obj_text(const Polylines& lines) {
  const Vertices vertices = distinct(lines.points);
  std::string text = "# limn silhouette: lines in the mesh's space\n";
  text.reserve(text.size() + 40 * vertices.positions.size() + 9 * lines.points.size());
  for (const Vec3& p : vertices.positions) {
    text += "v ";
    append_position(text, p);
  }
  for (std::size_t number = 0; number < kLayerCount; ++number) {
    bool begun = false;
    for (const Polyline& line : lines.lines) {
      if (layer_of(line.line_class, line.visible) != number) continue;
      if (!begun) text += "g " + layer_name(static_cast<Layer>(number)) + "\n";
      begun = true;
      append_obj_line(text, line, vertices);
    }
  }
  return text;
}

std::string ply_text(const Polylines& lines, bool ascii) {
  const Vertices vertices = distinct(lines.points);
  const std::vector<PlyEdge> edges = ply_edges(lines, vertices);
  std::string text =
      fmt::format("ply\nformat {} 1.0\ncomment limn silhouette\n", ascii ? "ascii" : "binary_little_endian");
  text += fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n",
                      vertices.positions.size());
  text += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", edges.size());
  text += "property uchar class\nproperty uchar visible\nproperty uchar outer\nproperty int line\nend_header\n";
  if (ascii) {
    append_ascii(text, vertices, edges);
  } else {
    append_binary(text, vertices, edges);
  }
  return text;
}

}  // namespace limn
