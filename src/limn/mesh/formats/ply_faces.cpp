#include <array>
#include <atomic>
#include <vector>

#include "limn/base/parallel.h"
#include "limn/mesh/formats/ply_body.h"
#include "limn/mesh/formats/polygon.h"

namespace limn::formats {
namespace {

constexpr std::uint64_t kMostTriangles = 0xffffffffu / 3;

/// Which properties of a face or strip are read; -1 for none.
struct FaceLayout {
  int indices = -1;
  int texcoords = -1;
};

/// One polygon while it is read; kept from face to face so that its memory is.
struct PolygonBuffer {
  std::vector<VertexId> corners;
  std::vector<float> texcoords;
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

FaceLayout layout_of(const PlyElement& element) {
  FaceLayout layout;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (!property.list) continue;
    const bool indices = property.name == "vertex_indices" || property.name == "vertex_index";
    if (indices && layout.indices < 0) layout.indices = static_cast<int>(i);
    if (property.name == "texcoord" && layout.texcoords < 0) layout.texcoords = static_cast<int>(i);
  }
  return layout;
}

/// The list is missing: without it a face has no corners.
tl::unexpected<Error> no_indices(const PlyReading& reading, const PlyElement& element) {
  return fail_at(ErrorCode::kUnreadable, reading.source.name, "header",
                 fmt::format("element '{}' has no list 'vertex_indices'", element.name));
}

void note_left_out(PlyReading& reading, const PlyElement& element, const FaceLayout& layout) {
  std::size_t left_out = 0;
  std::string example;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (static_cast<int>(i) == layout.indices || static_cast<int>(i) == layout.texcoords) continue;
    if (left_out++ == 0) example = in_quotes(element.properties[i].name);
  }
  if (left_out > 0) {
    reading.result.notes.push_back(
        fmt::format("{} {} properties left out, the first {}", left_out, element.name, example));
  }
}

/// Reads a list of indices; false with a problem when one is out of range.
template <class Cursor>
bool read_indices(const PlyReading& reading, Cursor& cursor, const PlyProperty& property, bool cut_marks,
                  std::vector<VertexId>& indices) {
  indices.clear();
  std::uint64_t count = 0;
  if (!read_list_count(cursor, property, count)) return false;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::int64_t index = 0;
    if (!cursor.read_whole(property.type, index)) return false;
    const bool cut = cut_marks && index == -1;
    if (!cut && (index < 0 || static_cast<std::uint64_t>(index) >= reading.vertex_count)) {
      cursor.set_problem(
          fmt::format("refers to vertex {}, but there are {} (counted from 0)", index, reading.vertex_count));
      return false;
    }
    indices.push_back(cut ? kInvalidId : static_cast<VertexId>(index));
  }
  return true;
}

template <class Cursor>
bool read_reals(Cursor& cursor, const PlyProperty& property, std::vector<float>& values) {
  values.clear();
  std::uint64_t count = 0;
  if (!read_list_count(cursor, property, count)) return false;
  for (std::uint64_t i = 0; i < count; ++i) {
    float value = 0;
    if (!cursor.read_real(property.type, value)) return false;
    values.push_back(value);
  }
  return true;
}

/// Cuts a polygon into triangles of its corners; a fan where the vertices come after the faces.
void cut(const PlyReading& reading, PolygonBuffer& polygon) {
  const std::vector<VertexId>& corners = polygon.corners;
  const std::vector<Vec3>& positions = reading.result.mesh.positions;
  polygon.triangles.clear();
  if (corners.size() < 3) return;
  if (corners.size() > 3 && positions.size() == reading.vertex_count) {
    polygon.points.clear();
    for (const VertexId corner : corners)
      polygon.points.push_back(positions[corner]);
    triangulate(polygon.points, polygon.triangles);
    return;
  }
  for (std::uint32_t i = 2; i < corners.size(); ++i)
    polygon.triangles.push_back({0, i - 1, i});
}

void add_polygon(PlyReading& reading, const PolygonBuffer& polygon) {
  if (polygon.corners.size() < 3) ++reading.too_small;
  if (polygon.corners.size() > 3) {
    ++reading.polygons;
    reading.polygon_triangles += polygon.triangles.size();
  }
  for (const auto& [a, b, c] : polygon.triangles) {
    reading.result.mesh.faces.push_back({polygon.corners[a], polygon.corners[b], polygon.corners[c]});
  }
}

/// Adds the texture coordinates of a polygon's corners, two numbers each; zeros where the list does not fit.
void add_texcoords(PlyReading& reading, const PolygonBuffer& polygon) {
  const bool fits = polygon.texcoords.size() == 2 * polygon.corners.size();
  reading.wrong_texcoords += !fits && !polygon.triangles.empty();
  for (const auto& triangle : polygon.triangles) {
    for (const std::size_t corner : triangle) {
      const Vec2 uv = fits ? Vec2(polygon.texcoords[2 * corner], polygon.texcoords[2 * corner + 1]) : Vec2(0.0f);
      reading.result.mesh.uvs.values.push_back(uv);
    }
  }
}

bool too_many(const PlyReading& reading) {
  return reading.result.mesh.faces.size() > kMostTriangles;
}

template <class Cursor>
Result<void> read_polygons(PlyReading& reading, const PlyElement& element, const FaceLayout& layout, Cursor& cursor) {
  PolygonBuffer polygon;
  if (layout.texcoords >= 0) reading.result.mesh.uvs = {};
  const std::uint64_t room = cursor.most_triangles(element.properties[static_cast<std::size_t>(layout.indices)]);
  reading.result.mesh.faces.reserve(static_cast<std::size_t>(std::min(element.count, room)));
  for (std::uint64_t face = 0; face < element.count; ++face) {
    if (cancelled(reading, face, element.count)) return fail(ErrorCode::kCancelled, "reading was cancelled");
    bool good = cursor.begin_item();
    for (std::size_t i = 0; good && i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (static_cast<int>(i) == layout.indices) {
        good = read_indices(reading, cursor, property, false, polygon.corners);
      } else if (static_cast<int>(i) == layout.texcoords) {
        good = read_reals(cursor, property, polygon.texcoords);
      } else {
        good = skip_property(cursor, property);
      }
    }
    if (!good || !cursor.end_item()) return ply_failure(reading, "face", face, cursor);
    cut(reading, polygon);
    add_polygon(reading, polygon);
    if (layout.texcoords >= 0) add_texcoords(reading, polygon);
    if (too_many(reading))
      return ply_failure(reading, "more triangles than 32-bit indices can name, at face", face, cursor);
  }
  return {};
}

/// Gives corners their texture coordinates' numbers: they were stored corner by corner.
void index_texcoords(Mesh& mesh) {
  mesh.uvs.indices.resize(mesh.uvs.values.size());
  for (std::size_t i = 0; i < mesh.uvs.indices.size(); ++i)
    mesh.uvs.indices[i] = static_cast<std::uint32_t>(i);
}

/// The common case at memory speed: one list of triangles with a byte for a count and 32-bit indices, scalars around
/// it. False, leaving the cursor where it was, when the element is of another kind, a face no triangle or an index out
/// of range: the careful way then says what is wrong.
bool read_triangles(PlyReading& reading, const PlyElement& element, const FaceLayout& layout, PlyBinaryCursor& cursor) {
  constexpr std::size_t kGrain = 1u << 16;
  const PlyProperty& list = element.properties[static_cast<std::size_t>(layout.indices)];
  const bool plain =
      size_of(list.count_type) == 1 && (list.type == PlyScalar::kInt32 || list.type == PlyScalar::kUint32);
  if (!plain || layout.texcoords >= 0 || !reading.result.mesh.faces.empty()) return false;
  std::size_t offset = 0;
  std::size_t step = sizeof(Triangle);
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.list && static_cast<int>(i) != layout.indices) return false;
    if (static_cast<int>(i) < layout.indices) offset += size_of(property.type);
    step += property.list ? 1 : size_of(property.type);
  }
  const auto count = static_cast<std::size_t>(element.count);
  if (count > cursor.bytes_left() / step || count > kMostTriangles) return false;
  std::vector<Triangle>& faces = reading.result.mesh.faces;
  faces.resize(count);
  const std::byte* const from = cursor.data() + offset;
  const bool swap = cursor.swap();
  std::atomic<bool> good = true;
  parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
    bool threes = true;
    VertexId largest = 0;
    for (std::size_t face = begin; face < end; ++face) {
      const std::byte* const at = from + face * step;
      threes &= *at == std::byte{3};
      const Triangle triangle{load<VertexId>(at + 1, swap), load<VertexId>(at + 5, swap), load<VertexId>(at + 9, swap)};
      largest = std::max(largest, std::max(triangle[0], std::max(triangle[1], triangle[2])));
      faces[face] = triangle;
    }
    if (!threes || largest >= reading.vertex_count) good = false;
  });
  if (good) {
    cursor.advance(count * step);
  } else {
    faces.clear();
  }
  return good;
}

template <class Cursor>
Result<void> read_any_faces(PlyReading& reading, const PlyElement& element, const FaceLayout& layout, Cursor& cursor) {
  Result<void> done = read_polygons(reading, element, layout, cursor);
  if (done && layout.texcoords >= 0) index_texcoords(reading.result.mesh);
  return done;
}

/// Adds a strip's triangles; those with a repeated vertex only join parts of the strip and are left out.
void add_strip(PlyReading& reading, const std::vector<VertexId>& strip) {
  std::size_t start = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] == kInvalidId) {
      start = i + 1;
      continue;
    }
    if (i < start + 2) continue;
    const VertexId a = strip[i - 2];
    const VertexId b = strip[i - 1];
    const VertexId c = strip[i];
    if (a == b || b == c || c == a) continue;
    reading.result.mesh.faces.push_back((i - start) % 2 == 0 ? Triangle{a, b, c} : Triangle{b, a, c});
    ++reading.strip_triangles;
  }
}

template <class Cursor>
Result<void> read_strips(PlyReading& reading, const PlyElement& element, Cursor& cursor) {
  const FaceLayout layout = layout_of(element);
  if (layout.indices < 0) return no_indices(reading, element);
  std::vector<VertexId> strip;
  for (std::uint64_t item = 0; item < element.count; ++item) {
    if (cancelled(reading, item, element.count)) return fail(ErrorCode::kCancelled, "reading was cancelled");
    bool good = cursor.begin_item();
    for (std::size_t i = 0; good && i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      good = static_cast<int>(i) == layout.indices ? read_indices(reading, cursor, property, true, strip)
                                                   : skip_property(cursor, property);
    }
    if (!good || !cursor.end_item()) return ply_failure(reading, "strip", item, cursor);
    add_strip(reading, strip);
    if (too_many(reading))
      return ply_failure(reading, "more triangles than 32-bit indices can name, at strip", item, cursor);
  }
  return {};
}

}  // namespace

Result<void> read_ply_faces(PlyReading& reading, const PlyElement& element, PlyBinaryCursor& cursor) {
  const FaceLayout layout = layout_of(element);
  if (layout.indices < 0) return no_indices(reading, element);
  note_left_out(reading, element, layout);
  if (read_triangles(reading, element, layout, cursor)) return {};
  return read_any_faces(reading, element, layout, cursor);
}

Result<void> read_ply_faces(PlyReading& reading, const PlyElement& element, PlyTextCursor& cursor) {
  const FaceLayout layout = layout_of(element);
  if (layout.indices < 0) return no_indices(reading, element);
  note_left_out(reading, element, layout);
  return read_any_faces(reading, element, layout, cursor);
}

Result<void> read_ply_strips(PlyReading& reading, const PlyElement& element, PlyBinaryCursor& cursor) {
  return read_strips(reading, element, cursor);
}

Result<void> read_ply_strips(PlyReading& reading, const PlyElement& element, PlyTextCursor& cursor) {
  return read_strips(reading, element, cursor);
}

}  // namespace limn::formats
