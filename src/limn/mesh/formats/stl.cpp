#include <atomic>
#include <bit>
#include <cctype>
#include <cstring>
#include <fmt/format.h>

#include "limn/base/parallel.h"
#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/stl_kind.h"
#include "limn/mesh/formats/text.h"

namespace limn::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies in memory");

constexpr std::size_t kMostFacets = 0xffffffffu / 3 - 1;

/// Three new vertices a facet: STL knows no others; build_topology() joins them.
void number_corners(Mesh& mesh) {
  mesh.faces.resize(mesh.positions.size() / 3);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto first = static_cast<VertexId>(3 * face);
    mesh.faces[face] = {first, first + 1, first + 2};
  }
}

Result<ImportedMesh> read_binary(const Source& source) {
  const std::span<const std::byte> bytes = source.bytes;
  if (bytes.size() < kStlHeaderSize) {
    return fail_at(ErrorCode::kUnreadable, source.name, fmt::format("byte {}", bytes.size()),
                   fmt::format("truncated: neither 'solid' nor the {} bytes of a binary header", kStlHeaderSize));
  }
  const std::size_t count = stl_facet_count(bytes);
  const std::size_t there = (bytes.size() - kStlHeaderSize) / kStlFacetSize;
  if (count > there) {
    return fail_at(ErrorCode::kUnreadable, source.name, fmt::format("facet {} (byte {})", there, bytes.size()),
                   fmt::format("truncated: the header claims {} facets, {} are there", count, there),
                   "get a complete copy of the file");
  }
  if (count > kMostFacets) {
    return fail_at(ErrorCode::kUnreadable, source.name, "header", "more corners than 32-bit indices can name");
  }
  ImportedMesh result;
  result.format = MeshFormat::kStl;
  result.mesh.positions.resize(3 * count);
  std::atomic<bool> attributes = false;
  const std::byte* const first = bytes.data() + kStlHeaderSize;
  parallel_for(count, std::size_t{1} << 15, [&](std::size_t begin, std::size_t end) {
    bool any = false;
    for (std::size_t facet = begin; facet < end; ++facet) {
      const std::byte* const at = first + facet * kStlFacetSize;
      std::memcpy(&result.mesh.positions[3 * facet], at + sizeof(Vec3), 3 * sizeof(Vec3));
      any |= at[48] != std::byte{0} || at[49] != std::byte{0};
    }
    if (any) attributes = true;
  });
  number_corners(result.mesh);
  if (attributes) result.notes.emplace_back("attribute bytes of facets (colours to some programs) left out");
  const std::size_t behind = bytes.size() - kStlHeaderSize - count * kStlFacetSize;
  if (behind > 0) result.notes.push_back(fmt::format("{} bytes behind the last facet left out", behind));
  return result;
}

bool same_word(std::string_view word, std::string_view lower_case) {
  if (word.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (std::tolower(static_cast<unsigned char>(word[i])) != lower_case[i]) return false;
  }
  return true;
}

/// Reads the lines of text STL: a small machine over its keywords.
class TextStl {
 public:
  TextStl(const Source& source, ImportedMesh& result)
      : source_(source),
        result_(result),
        text_(std::string_view(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size())) {}

  Result<void> read() {
    while (text_.advance()) {
      if (text_.line() % kLinesBetweenReports == 0 && !report_progress()) {
        return fail(ErrorCode::kCancelled, "reading was cancelled");
      }
      while (!text_.line_done()) {
        if (Result<void> done = read_word(text_.token()); !done) return done;
      }
    }
    if (in_facet_) return complain(fmt::format("truncated: the file ends in facet {}", facets_));
    if (in_solid_) result_.notes.emplace_back("the last solid has no 'endsolid'");
    if (solids_ > 1) result_.notes.push_back(fmt::format("{} solids joined into one mesh", solids_));
    return {};
  }

 private:
  static constexpr std::size_t kLinesBetweenReports = 1u << 16;

  bool report_progress() const {
    const auto left = static_cast<double>(text_.bytes_left());
    return report(source_.progress, "reading", 1.0 - left / static_cast<double>(source_.bytes.size()));
  }

  tl::unexpected<Error> complain(std::string message) const {
    return fail_at(ErrorCode::kUnreadable, source_.name, fmt::format("line {}", text_.line()), std::move(message));
  }

  Result<void> read_word(std::string_view word) {
    if (same_word(word, "vertex")) return read_vertex();
    if (same_word(word, "facet")) return begin_facet();
    if (same_word(word, "endfacet")) return end_facet();
    if (same_word(word, "outer") || same_word(word, "endloop")) return read_loop(word);
    if (same_word(word, "solid")) return begin_solid();
    if (same_word(word, "endsolid")) return end_solid();
    return complain(fmt::format("unknown keyword {}", in_quotes(word)));
  }

  Result<void> read_vertex() {
    Vec3 point;
    if (!in_facet_) return complain("a vertex outside a facet");
    if (!text_.real(point.x) || !text_.real(point.y) || !text_.real(point.z)) {
      const bool cut = text_.line_done() && text_.rest().empty();
      return complain(cut ? fmt::format("truncated: the file ends in facet {}", facets_)
                          : fmt::format("a vertex of facet {} lacks three numbers", facets_));
    }
    if (++corners_ > 3) return complain(fmt::format("facet {} has more than three vertices", facets_));
    result_.mesh.positions.push_back(point);
    return {};
  }

  /// The facet's normal is passed over: its winding says as much, and programs disagree about it.
  Result<void> begin_facet() {
    if (in_facet_) return complain(fmt::format("facet {} is not closed with 'endfacet'", facets_));
    if (facets_ == kMostFacets) return complain("more corners than 32-bit indices can name");
    in_facet_ = true;
    corners_ = 0;
    drop_line();
    return {};
  }

  Result<void> end_facet() {
    if (!in_facet_) return complain("'endfacet' without 'facet'");
    if (corners_ != 3) return complain(fmt::format("facet {} has {} vertices, not three", facets_, corners_));
    in_facet_ = false;
    ++facets_;
    return {};
  }

  Result<void> read_loop(std::string_view word) {
    if (!in_facet_) return complain(in_quotes(word) + " outside a facet");
    if (same_word(word, "outer") && !same_word(text_.token(), "loop")) return complain("'outer' without 'loop'");
    return {};
  }

  Result<void> begin_solid() {
    if (in_facet_) return complain(fmt::format("facet {} is not closed with 'endfacet'", facets_));
    in_solid_ = true;
    ++solids_;
    drop_line();
    return {};
  }

  Result<void> end_solid() {
    if (in_facet_) return complain(fmt::format("facet {} is not closed with 'endfacet'", facets_));
    in_solid_ = false;
    drop_line();
    return {};
  }

  /// Passes over the rest of a line; an "outer loop" written behind a facet's normal is kept.
  void drop_line() {
    while (!text_.line_done() && !(in_facet_ && same_word(text_.peek(), "outer")))
      text_.token();
  }

  const Source& source_;
  ImportedMesh& result_;
  TextLines text_;
  std::size_t facets_ = 0;
  std::size_t solids_ = 0;
  int corners_ = 0;
  bool in_facet_ = false;
  bool in_solid_ = false;
};

}  // namespace

Result<ImportedMesh> read_stl(const Source& source) {
  if (stl_kind_of(source.bytes) != StlKind::kText) return read_binary(source);
  ImportedMesh result;
  result.format = MeshFormat::kStl;
  if (const Result<void> done = TextStl(source, result).read(); !done) return tl::unexpected(done.error());
  number_corners(result.mesh);
  return result;
}

}  // namespace limn::formats
