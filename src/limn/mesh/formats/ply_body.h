#pragma once

#include <cstdint>
#include <string>

#include "limn/mesh/formats/ply_cursor.h"
#include "limn/mesh/formats/ply_header.h"

/// The parts of the PLY reader: one for each element it understands.
namespace limn::formats {

/// What the parts share while a file is read.
struct PlyReading {
  const Source& source;
  const PlyHeader& header;
  ImportedMesh& result;
  std::uint64_t vertex_count = 0;  ///< as the header claims, held against the file's size

  std::uint64_t polygons = 0;           ///< faces of more than three corners
  std::uint64_t polygon_triangles = 0;  ///< what became of them
  std::uint64_t too_small = 0;          ///< faces of fewer than three corners
  std::uint64_t strip_triangles = 0;
  std::uint64_t wrong_texcoords = 0;  ///< faces whose list of texture coordinates does not fit
};

/// Reads the vertex element; the cursor ends behind it.
Result<void> read_ply_vertices(PlyReading& reading, const PlyElement& element, PlyBinaryCursor& cursor);
Result<void> read_ply_vertices(PlyReading& reading, const PlyElement& element, PlyTextCursor& cursor);

/// Reads the face element; polygons are cut into triangles. Every index is checked.
Result<void> read_ply_faces(PlyReading& reading, const PlyElement& element, PlyBinaryCursor& cursor);
Result<void> read_ply_faces(PlyReading& reading, const PlyElement& element, PlyTextCursor& cursor);

/// Reads the tristrips element: strips cut at -1, every other triangle turned. Every index is checked.
Result<void> read_ply_strips(PlyReading& reading, const PlyElement& element, PlyBinaryCursor& cursor);
Result<void> read_ply_strips(PlyReading& reading, const PlyElement& element, PlyTextCursor& cursor);

/// "face 3 (byte 120)" with the cursor's problem.
template <class Cursor>
tl::unexpected<Error> ply_failure(const PlyReading& reading, const char* item, std::uint64_t index,
                                  const Cursor& cursor) {
  return fail_at(ErrorCode::kUnreadable, reading.source.name, fmt::format("{} {} ({})", item, index, cursor.where()),
                 cursor.problem(), cursor.truncated() ? "get a complete copy of the file" : "");
}

/// Reads or skips a list's count; false with a problem when it cannot be.
template <class Cursor>
bool read_list_count(Cursor& cursor, const PlyProperty& property, std::uint64_t& count) {
  std::int64_t value = 0;
  if (!cursor.read_whole(property.count_type, value)) return false;
  if (value < 0) {
    cursor.set_problem(fmt::format("a list of {} values", value));
    return false;
  }
  count = static_cast<std::uint64_t>(value);
  return cursor.has_values(count, property.type);
}

/// Passes over a property that is not wanted.
template <class Cursor>
bool skip_property(Cursor& cursor, const PlyProperty& property) {
  std::uint64_t count = 1;
  if (property.list && !read_list_count(cursor, property, count)) return false;
  return cursor.skip(property.type, count);
}

/// Whether the caller wants to stop; asked every so many items.
inline bool cancelled(const PlyReading& reading, std::uint64_t item, std::uint64_t count) {
  constexpr std::uint64_t kItemsBetweenReports = 1u << 16;
  if (item % kItemsBetweenReports != 0) return false;
  return !report(reading.source.progress, "reading", static_cast<double>(item) / static_cast<double>(count));
}

}  // namespace limn::formats
