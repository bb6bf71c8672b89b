#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "limn/mesh/formats/color.h"
#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/polygon.h"
#include "limn/mesh/formats/text.h"

namespace limn::formats {
namespace {

/// What the keyword on the first line says of each vertex: [ST][C][N]OFF.
struct OffKind {
  bool texcoords = false;
  bool colors = false;
  bool normals = false;
};

class OffReader {
 public:
  explicit OffReader(const Source& source)
      : source_(source),
        text_(std::string_view(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size())) {}

  Result<ImportedMesh> read() {
    result_.format = MeshFormat::kOff;
    for (const auto step : {&OffReader::read_header, &OffReader::read_vertices, &OffReader::read_faces}) {
      if (const Result<void> done = (this->*step)(); !done) return tl::unexpected(done.error());
    }
    finish_colors();
    add_notes();
    return std::move(result_);
  }

 private:
  tl::unexpected<Error> complain(std::string message, std::string remedy = {}) const {
    return fail_at(ErrorCode::kUnreadable, source_.name, fmt::format("line {}", text_.line()), std::move(message),
                   std::move(remedy));
  }

  bool next_line() { return text_.advance('#'); }

  Result<void> read_header() {
    if (!next_line()) return complain("no OFF file: there is nothing in it");
    if (Result<void> keyword = read_keyword(); !keyword) return keyword;
    if (text_.line_done() && !next_line()) return complain("the file ends before its counts");
    std::int64_t counts[3] = {0, 0, 0};
    for (int i = 0; i < 2; ++i) {
      if (!text_.whole(counts[i])) return complain("the counts of vertices and faces are missing");
      if (counts[i] < 0) return complain(fmt::format("a count of {}", counts[i]));
    }
    text_.whole(counts[2]);  // edges: not needed, often wrong, sometimes absent
    if (!text_.line_done()) return complain(fmt::format("{} behind the counts", in_quotes(text_.peek())));
    vertex_count_ = static_cast<std::uint64_t>(counts[0]);
    face_count_ = static_cast<std::uint64_t>(counts[1]);
    return check_claims();
  }

  /// Takes the keyword; the counts may follow it on its line, even without a blank between ("OFF490 518 0").
  Result<void> read_keyword() {
    const std::string_view word = text_.peek();
    const std::size_t off = word.find("OFF");
    if (off == std::string_view::npos) {
      const bool counts = !word.empty() && std::isdigit(static_cast<unsigned char>(word.front()));
      return counts ? Result<void>{} : complain("no OFF file: it does not begin with 'OFF'");
    }
    std::string_view prefix = word.substr(0, off);
    const auto take = [&prefix](std::string_view flag) {
      const bool there = prefix.starts_with(flag);
      if (there) prefix.remove_prefix(flag.size());
      return there;
    };
    kind_.texcoords = take("ST");
    kind_.colors = take("C");
    kind_.normals = take("N");
    if (prefix.starts_with('4') || prefix.starts_with('n'))
      return complain("vertices of more than three dimensions", "project the model to three dimensions");
    if (!prefix.empty()) return complain(fmt::format("unknown keyword {}", in_quotes(word)));
    text_.take(off + 3);
    if (text_.peek() == "BINARY")
      return complain("binary OFF is not supported", "convert the file to text OFF or to PLY");
    return {};
  }

  /// Vertices and faces take a line each, the shortest "0 0 0" and "0".
  Result<void> check_claims() {
    const std::uint64_t lines = text_.rest().size() / 2 + 1;
    if (vertex_count_ <= lines / 3 + 1 && face_count_ <= lines) return {};
    return complain(fmt::format("truncated: {} vertices and {} faces are claimed, {} bytes follow", vertex_count_,
                                face_count_, text_.rest().size()),
                    "get a complete copy of the file");
  }

  bool cancelled(std::uint64_t item) const {
    constexpr std::uint64_t kItemsBetweenReports = 1u << 16;
    if (item % kItemsBetweenReports != 0) return false;
    const auto left = static_cast<double>(text_.bytes_left());
    return !report(source_.progress, "reading", 1.0 - left / static_cast<double>(source_.bytes.size()));
  }

  Result<void> read_vertices() {
    Mesh& mesh = result_.mesh;
    const auto count = static_cast<std::size_t>(vertex_count_);
    mesh.positions.reserve(count);
    for (std::uint64_t vertex = 0; vertex < vertex_count_; ++vertex) {
      if (cancelled(vertex)) return fail(ErrorCode::kCancelled, "reading was cancelled");
      if (!next_line()) {
        return complain(
            fmt::format("truncated: {} vertices are claimed, the file ends before vertex {}", vertex_count_, vertex));
      }
      Vec3 position;
      Vec3 normal;
      if (!read_vector(position) || (kind_.normals && !read_vector(normal))) {
        return complain(
            fmt::format("vertex {} needs {} numbers, not {}", vertex, kind_.normals ? 6 : 3, in_quotes(text_.peek())));
      }
      mesh.positions.push_back(position);
      if (kind_.normals) mesh.normals.values.push_back(normal);
      if (Result<void> done = read_extras(vertex); !done) return done;
    }
    return {};
  }

  bool read_vector(Vec3& v) { return text_.real(v.x) && text_.real(v.y) && text_.real(v.z); }

  /// What follows position and normal: three or four numbers of colour, two texture coordinates, as the keyword has it.
  Result<void> read_extras(std::uint64_t vertex) {
    constexpr std::size_t kMost = 6;
    float values[kMost];
    std::size_t count = 0;
    while (!text_.line_done()) {
      if (count == kMost) return complain(fmt::format("vertex {} has more numbers than OFF knows", vertex));
      const std::string_view word = text_.peek();
      if (!text_.real(values[count]))
        return complain(fmt::format("{} in vertex {} is no number", in_quotes(word), vertex));
      ++count;
    }
    const std::size_t texcoords = kind_.texcoords ? 2 : 0;
    if (!kind_.colors && texcoords == 0) {
      extra_vertices_ += count > 0;
      return {};
    }
    const std::size_t color = count - std::min(count, texcoords);
    if (count < texcoords || (kind_.colors ? color != 3 && color != 4 : color != 0)) {
      return complain(fmt::format("vertex {} has {} numbers behind its position and normal", vertex, count));
    }
    if (kind_.colors) {
      // Colours are fractions, or whole numbers up to 255: one above 1 tells.
      byte_colors_ |= std::any_of(values, values + color, [](float value) { return value > 1.0f; });
      result_.mesh.colors.values.emplace_back(values[0], values[1], values[2], color == 4 ? values[3] : 1.0f);
      opaque_.push_back(color == 3);
    }
    if (texcoords > 0) result_.mesh.uvs.values.emplace_back(values[color], values[color + 1]);
    return {};
  }

  Result<void> read_faces() {
    std::vector<VertexId> corners;
    for (std::uint64_t face = 0; face < face_count_; ++face) {
      if (cancelled(face)) return fail(ErrorCode::kCancelled, "reading was cancelled");
      if (!next_line()) {
        return complain(
            fmt::format("truncated: {} faces are claimed, the file ends before face {}", face_count_, face));
      }
      if (Result<void> done = read_corners(face, corners); !done) return done;
      face_colors_ += !text_.line_done();
      add_polygon(corners);
    }
    if (next_line()) {
      result_.notes.push_back(fmt::format("{} bytes behind the last face left out", text_.bytes_left()));
    }
    return {};
  }

  Result<void> read_corners(std::uint64_t face, std::vector<VertexId>& corners) {
    std::int64_t count = 0;
    corners.clear();
    if (!text_.whole(count) || count < 0)
      return complain(fmt::format("face {} does not begin with its number of corners", face));
    for (std::int64_t i = 0; i < count; ++i) {
      std::int64_t index = 0;
      if (!text_.whole(index)) return complain(fmt::format("face {} claims {} corners, {} are there", face, count, i));
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) {
        return complain(
            fmt::format("face {} refers to vertex {}, but there are {} (counted from 0)", face, index, vertex_count_));
      }
      corners.push_back(static_cast<VertexId>(index));
    }
    return {};
  }

  void add_polygon(const std::vector<VertexId>& corners) {
    if (corners.size() == 3) result_.mesh.faces.push_back({corners[0], corners[1], corners[2]});
    if (corners.size() < 3) ++too_small_;
    if (corners.size() <= 3) return;
    points_.clear();
    triangles_.clear();
    for (const VertexId corner : corners)
      points_.push_back(result_.mesh.positions[corner]);
    triangulate(points_, triangles_);
    ++polygons_;
    polygon_triangles_ += triangles_.size();
    for (const auto& [a, b, c] : triangles_)
      result_.mesh.faces.push_back({corners[a], corners[b], corners[c]});
  }

  /// Bytes are sRGB, as in PLY; an alpha that was not written stays 1.
  void finish_colors() {
    if (!byte_colors_) return;
    const auto linear = [](float byte) {
      if (std::isnan(byte)) return byte;  // stays, so that the check behind every reader finds it
      return linear_of_srgb_byte()[static_cast<std::size_t>(std::clamp(byte, 0.0f, 255.0f))];
    };
    for (std::size_t i = 0; i < result_.mesh.colors.values.size(); ++i) {
      Vec4& color = result_.mesh.colors.values[i];
      const float alpha = opaque_[i] ? 1.0f : std::clamp(color.a / 255.0f, 0.0f, 1.0f);
      color = Vec4(linear(color.r), linear(color.g), linear(color.b), alpha);
    }
  }

  void add_notes() {
    std::vector<std::string>& notes = result_.notes;
    if (polygons_ > 0) notes.push_back(fmt::format("{} polygons cut into {} triangles", polygons_, polygon_triangles_));
    if (too_small_ > 0) notes.push_back(fmt::format("{} faces of fewer than three corners left out", too_small_));
    if (face_colors_ > 0) notes.push_back(fmt::format("colours of {} faces left out", face_colors_));
    if (extra_vertices_ > 0) notes.push_back(fmt::format("further numbers of {} vertices left out", extra_vertices_));
  }

  const Source& source_;
  TextLines text_;
  ImportedMesh result_;
  OffKind kind_;
  std::uint64_t vertex_count_ = 0;
  std::uint64_t face_count_ = 0;
  std::vector<bool> opaque_;  ///< one a vertex with a colour: no alpha was written
  bool byte_colors_ = false;
  std::vector<Vec3> points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::uint64_t polygons_ = 0;
  std::uint64_t polygon_triangles_ = 0;
  std::uint64_t too_small_ = 0;
  std::uint64_t face_colors_ = 0;
  std::uint64_t extra_vertices_ = 0;
};

}  // namespace

Result<ImportedMesh> read_off(const Source& source) {
  return OffReader(source).read();
}

Result<std::vector<OutputFile>> write_off(const Mesh& mesh, const std::filesystem::path& path) {
  constexpr std::size_t kTypicalLine = 32;
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.positions.size(), mesh.faces.size());
  text.reserve((mesh.positions.size() + mesh.faces.size()) * kTypicalLine);
  for (const Vec3& p : mesh.positions) {
    append_position(text, p);
  }
  for (const Triangle& face : mesh.faces) {
    text += '3';
    for (const VertexId vertex : face) {
      text += ' ';
      append_number(text, std::uint64_t{vertex});
    }
    text += '\n';
  }
  return std::vector<OutputFile>{{path, std::move(text)}};
}

}  // namespace limn::formats
