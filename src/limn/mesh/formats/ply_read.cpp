#include "limn/mesh/formats/ply_body.h"

namespace limn::formats {
namespace {

constexpr std::uint64_t kMostVertices = 0xfffffffeu;

/// Whether every element can be in the file at all: what the header claims is believed only after this.
Result<void> check_claims(const Source& source, const PlyHeader& header) {
  std::uint64_t left = source.bytes.size() - header.size;
  for (const PlyElement& element : header.elements) {
    // In text a value takes a digit and what parts it from the next; the last of the file may lack that.
    const std::uint64_t each =
        header.encoding == PlyEncoding::kAscii ? 2 * element.properties.size() : element.smallest_size();
    const std::uint64_t there = header.encoding == PlyEncoding::kAscii ? left + 1 : left;
    if (each > 0 && element.count > there / each) {
      return fail_at(
          ErrorCode::kUnreadable, source.name,
          fmt::format("{} {}, byte {}", element.name, there / each, source.bytes.size()),
          fmt::format("truncated: the header claims {} {} elements of at least {} bytes, {} bytes are left for them",
                      element.count, element.name, each, left),
          "get a complete copy of the file");
    }
    left = there - element.count * each;
  }
  const PlyElement* const vertices = header.find("vertex");
  if (vertices && vertices->count > kMostVertices) {
    return fail_at(ErrorCode::kUnreadable, source.name, "header", "more vertices than 32-bit indices can name");
  }
  return {};
}

Result<void> skip_element(PlyReading& reading, const PlyElement& element, PlyTextCursor& cursor) {
  if (element.properties.empty()) return {};
  for (std::uint64_t item = 0; item < element.count; ++item) {
    if (!cursor.begin_item()) return ply_failure(reading, element.name.c_str(), item, cursor);
  }
  return {};
}

Result<void> skip_element(PlyReading& reading, const PlyElement& element, PlyBinaryCursor& cursor) {
  if (!element.has_list()) {
    const std::size_t size = element.smallest_size();
    if (size == 0) return {};
    if (!cursor.has(element.count, size)) return ply_failure(reading, element.name.c_str(), 0, cursor);
    cursor.advance(static_cast<std::size_t>(element.count) * size);
    return {};
  }
  for (std::uint64_t item = 0; item < element.count; ++item) {
    for (const PlyProperty& property : element.properties) {
      if (!skip_property(cursor, property)) return ply_failure(reading, element.name.c_str(), item, cursor);
    }
  }
  return {};
}

/// A binary element without lists has to be there in full before memory is taken for it.
Result<void> check_vertices_present(const PlyReading& reading, const PlyElement& element,
                                    const PlyBinaryCursor& cursor) {
  const std::size_t size = element.smallest_size();
  const std::uint64_t there = size > 0 ? cursor.bytes_left() / size : 0;
  if (element.count <= there || size == 0) return {};
  return fail_at(ErrorCode::kUnreadable, reading.source.name,
                 fmt::format("vertex {} (byte {})", there, cursor.offset() + there * size),
                 fmt::format("truncated: the header claims {} vertices of {} bytes", element.count, size),
                 "get a complete copy of the file");
}

Result<void> check_vertices_present(const PlyReading&, const PlyElement&, const PlyTextCursor&) {
  return {};
}

template <class Cursor>
Result<void> read_elements(PlyReading& reading, Cursor& cursor) {
  for (const PlyElement& element : reading.header.elements) {
    Result<void> done;
    if (element.name == "vertex") {
      done = check_vertices_present(reading, element, cursor);
      if (done) done = read_ply_vertices(reading, element, cursor);
    } else if (element.name == "face") {
      done = read_ply_faces(reading, element, cursor);
    } else if (element.name == "tristrips") {
      done = read_ply_strips(reading, element, cursor);
    } else {
      done = skip_element(reading, element, cursor);
      reading.result.notes.push_back(
          fmt::format("element {} left out ({} items)", in_quotes(element.name), element.count));
    }
    if (!done) return done;
  }
  return {};
}

void add_notes(PlyReading& reading) {
  std::vector<std::string>& notes = reading.result.notes;
  if (reading.polygons > 0) {
    notes.push_back(fmt::format("{} polygons cut into {} triangles", reading.polygons, reading.polygon_triangles));
  }
  if (reading.too_small > 0)
    notes.push_back(fmt::format("{} faces of fewer than three corners left out", reading.too_small));
  if (reading.strip_triangles > 0)
    notes.push_back(fmt::format("triangle strips unrolled: {} triangles", reading.strip_triangles));
  if (reading.wrong_texcoords > 0) {
    notes.push_back(
        fmt::format("{} faces without two texture coordinates a corner: (0, 0) there", reading.wrong_texcoords));
  }
}

void note_trailing(PlyReading& reading, std::size_t bytes) {
  if (bytes > 0) reading.result.notes.push_back(fmt::format("{} bytes behind the last element left out", bytes));
}

/// Strips and faces together: texture coordinates by corner cover the faces only.
void drop_partial_texcoords(Mesh& mesh) {
  if (!mesh.uvs.indices.empty() && mesh.uvs.indices.size() != 3 * mesh.faces.size()) mesh.uvs = {};
}

}  // namespace

Result<ImportedMesh> read_ply(const Source& source) {
  const Result<PlyHeader> header = parse_ply_header(source);
  if (!header) return tl::unexpected(header.error());
  if (const Result<void> possible = check_claims(source, *header); !possible) return tl::unexpected(possible.error());
  const PlyElement* const vertices = header->find("vertex");
  if (!vertices) return fail_at(ErrorCode::kUnreadable, source.name, "header", "the file has no vertex element");

  ImportedMesh result;
  result.format = MeshFormat::kPly;
  PlyReading reading{.source = source, .header = *header, .result = result, .vertex_count = vertices->count};
  Result<void> done;
  if (header->encoding == PlyEncoding::kAscii) {
    std::string_view text(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
    text.remove_prefix(header->size);
    std::string with_newlines;
    if (header->carriage_returns) {
      with_newlines = text;
      std::replace(with_newlines.begin(), with_newlines.end(), '\r', '\n');
      text = with_newlines;
    }
    PlyTextCursor cursor(text, header->lines);
    done = read_elements(reading, cursor);
    if (done && cursor.lines().advance()) note_trailing(reading, cursor.lines().bytes_left());
  } else {
    PlyBinaryCursor cursor(source.bytes, header->size, needs_swap(header->encoding));
    done = read_elements(reading, cursor);
    if (done) note_trailing(reading, cursor.bytes_left());
  }
  if (!done) return tl::unexpected(done.error());
  drop_partial_texcoords(result.mesh);
  add_notes(reading);
  return result;
}

}  // namespace limn::formats
