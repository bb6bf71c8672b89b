#include "limn/bake/tiles.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace limn::bake_detail {
namespace {

constexpr int kHighestAutomaticLevel = 4;
constexpr int kLargestSide = 16384;

/// What a square loses to keep two triangles apart at mip level `level`.
int lost_px(int level) {
  return level == 0 ? 3 : 3 * (1 << level) + 1;
}

/// From the square's side to the leg, in texels: half a texel more than half a texel of the mip level, so that legs run
/// through texel centres.
double inset_px(int level) {
  return level == 0 ? 0.5 : 0.5 * (1 << level) + 0.5;
}

std::size_t squares_of(int size_px, int tile_px) {
  const auto across = static_cast<std::size_t>(size_px / tile_px);
  return across * across;
}

/// The largest side, a multiple of 2^level, of which that many squares fit; 0 for none.
int largest_tile(std::size_t squares, int size_px, int level) {
  const int step = 1 << level;
  for (int tile = size_px / step * step; tile > 0; tile -= step) {
    if (squares_of(size_px, tile) >= squares) return tile;
  }
  return 0;
}

bool holds_triangles(int tile_px, int level) {
  return tile_px - lost_px(level) >= 1;
}

int automatic_level(std::size_t squares, int size_px) {
  int best = 0;
  for (int level = 1; level <= kHighestAutomaticLevel; ++level) {
    const int tile = largest_tile(squares, size_px, level);
    if (tile > 0 && 8 * lost_px(level) <= tile) best = level;
  }
  return best;
}

/// The smallest picture that would do; 0 where none does.
int size_needed(std::size_t squares, int level) {
  for (int size = 4; size <= kLargestSide; size *= 2) {
    if (holds_triangles(largest_tile(squares, size, level), level)) return size;
  }
  return 0;
}

/// The corner opposite the longest side.
int widest_corner(const Mesh& mesh, FaceId face) {
  const Triangle& t = mesh.faces[face];
  int widest = 0;
  double longest = -1.0;
  for (int c = 0; c < 3; ++c) {
    const DVec3 side = DVec3(mesh.positions[t[static_cast<std::size_t>((c + 1) % 3)]]) -
                       DVec3(mesh.positions[t[static_cast<std::size_t>((c + 2) % 3)]]);
    const double length = glm::dot(side, side);
    if (length > longest) {
      longest = length;
      widest = c;
    }
  }
  return widest;
}

/// In texels from the picture's top left: the right angle, then the others counter-clockwise as seen.
std::array<glm::dvec2, 3> tile_corners(std::size_t face, const TileLayout& layout) {
  const std::size_t square = face / 2;
  const auto columns = static_cast<std::size_t>(layout.columns);
  const double left = static_cast<double>(square % columns) * layout.tile_px;
  const std::size_t row = square / columns;
  const double bottom = (static_cast<double>(row) + 1.0) * layout.tile_px;
  const double near = inset_px(layout.clean_mip_level), far = near + layout.leg_px;
  std::array<glm::dvec2, 3> local{glm::dvec2(near, near), glm::dvec2(far, near), glm::dvec2(near, far)};
  for (glm::dvec2& corner : local) {
    if (face % 2 == 1) corner = glm::dvec2(layout.tile_px) - corner;
    corner = glm::dvec2(left + corner.x, bottom - corner.y);
  }
  return local;
}

}  // namespace

Result<TileLayout> plan_tiles(std::size_t faces, int size_px, int clean_mip_level) {
  const std::size_t squares = (faces + 1) / 2;
  TileLayout layout;
  layout.size_px = size_px;
  layout.clean_mip_level = clean_mip_level < 0 ? automatic_level(squares, size_px) : clean_mip_level;
  layout.tile_px = largest_tile(squares, size_px, layout.clean_mip_level);
  if (!holds_triangles(layout.tile_px, layout.clean_mip_level)) {
    const int needed = size_needed(squares, layout.clean_mip_level);
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{} faces do not fit a picture of {} x {} texels", faces, size_px, size_px),
                needed > 0 ? fmt::format("take size {}", needed) : "take a mesh of fewer faces");
  }
  layout.leg_px = layout.tile_px - lost_px(layout.clean_mip_level);
  layout.columns = size_px / layout.tile_px;
  return layout;
}

CornerAttribute<Vec2> tile_uvs(const Mesh& mesh, const TileLayout& layout) {
  CornerAttribute<Vec2> uvs;
  uvs.values.resize(3 * mesh.faces.size());
  uvs.indices.resize(uvs.values.size());
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    const std::array<glm::dvec2, 3> corners = tile_corners(face, layout);
    const int first = widest_corner(mesh, face);
    for (int c = 0; c < 3; ++c) {
      const glm::dvec2 at = corners[static_cast<std::size_t>(c)] / double(layout.size_px);
      uvs.values[3 * std::size_t{face} + static_cast<std::size_t>((first + c) % 3)] = Vec2(at.x, 1.0 - at.y);
    }
  }
  for (std::size_t i = 0; i < uvs.indices.size(); ++i)
    uvs.indices[i] = static_cast<std::uint32_t>(i);
  return uvs;
}

TexelMap tile_texels(const Mesh& mesh, const CornerAttribute<Vec2>& uvs, const TileLayout& layout) {
  TexelMap map;
  map.size_px = layout.size_px;
  const auto size = static_cast<std::size_t>(layout.size_px);
  map.owner.assign(size * size, kInvalidId);
  map.frames.resize(mesh.faces.size());
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    glm::dvec2 corners[3];
    for (int c = 0; c < 3; ++c) {
      const glm::dvec2 uv(mesh.corner(uvs, face, c));
      corners[c] = glm::dvec2(uv.x, 1.0 - uv.y) * double(layout.size_px);
    }
    map.frames[face] = TexelFrame(corners);
  }
  const int used = layout.columns * layout.tile_px;
  for (int y = 0; y < used; ++y) {
    for (int x = 0; x < used; ++x) {
      const int square = y / layout.tile_px * layout.columns + x / layout.tile_px;
      const int i = x % layout.tile_px, j = layout.tile_px - 1 - y % layout.tile_px;
      const std::size_t face = 2 * static_cast<std::size_t>(square) + (i + j >= layout.tile_px ? 1 : 0);
      if (face < mesh.faces.size())
        map.owner[static_cast<std::size_t>(y) * size + static_cast<std::size_t>(x)] = static_cast<FaceId>(face);
    }
  }
  return map;
}

}  // namespace limn::bake_detail
