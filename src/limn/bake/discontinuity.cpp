#include "limn/bake/discontinuity.h"

#include <glm/geometric.hpp>
#include <utility>

#include "limn/bake/texel_map.h"

namespace limn {
namespace {

using bake_detail::Barycentric;
using bake_detail::TexelMap;

/// Texel frames again, from the texture coordinates that the maps were made for.
TexelMap frames_of(const BakedMaps& maps) {
  const Mesh& mesh = maps.mesh;
  TexelMap texels;
  texels.size_px = maps.positions.width;
  texels.wraps = maps.report.tile_px == 0;
  texels.frames.resize(mesh.faces.size());
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    glm::dvec2 corners[3];
    for (int c = 0; c < 3; ++c) {
      const glm::dvec2 uv(mesh.corner(mesh.uvs, face, c));
      corners[c] = glm::dvec2(uv.x, 1.0 - uv.y) * double(texels.size_px);
    }
    texels.frames[face] = bake_detail::TexelFrame(corners);
  }
  return texels;
}

class Finder {
 public:
  Finder(const BakedMaps& maps, double factor) : maps_(maps), texels_(frames_of(maps)), factor_(factor) {}

  Discontinuities find() {
    const int size = texels_.size_px;
    found_.marks.assign(maps_.owner.size(), 0);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        if (x + 1 < size) compare(x, y, x + 1, y);
        if (y + 1 < size) compare(x, y, x, y + 1);
      }
    }
    return std::move(found_);
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(texels_.size_px) + static_cast<std::size_t>(x);
  }

  bool inside(FaceId face, int x, int y) const {
    return texels_.frames[face].holds(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  }

  DVec3 on_low(FaceId face, int x, int y) const {
    const Barycentric at = texels_.at(face, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    const Triangle& t = maps_.mesh.faces[face];
    return DVec3(maps_.mesh.positions[t[0]]) * (1.0 - double(at.u) - double(at.v)) +
           DVec3(maps_.mesh.positions[t[1]]) * double(at.u) + DVec3(maps_.mesh.positions[t[2]]) * double(at.v);
  }

  DVec3 on_high(int x, int y) const {
    const float* const p = maps_.positions.pixel(x, y);
    return {p[0], p[1], p[2]};
  }

  void compare(int x0, int y0, int x1, int y1) {
    const FaceId face = maps_.owner[index(x0, y0)];
    if (face == kInvalidId || maps_.owner[index(x1, y1)] != face) return;
    if (!inside(face, x0, y0) || !inside(face, x1, y1)) return;
    ++found_.pairs;
    const double step = glm::length(on_low(face, x1, y1) - on_low(face, x0, y0));
    const double apart = glm::length(on_high(x1, y1) - on_high(x0, y0));
    if (!(apart > factor_ * step)) return;
    ++found_.breaks;
    found_.marks[index(x0, y0)] = found_.marks[index(x1, y1)] = 1;
  }

  const BakedMaps& maps_;
  TexelMap texels_;
  double factor_;
  Discontinuities found_;
};

}  // namespace

Result<Discontinuities> find_discontinuities(const BakedMaps& maps, double factor) {
  if (maps.positions.empty()) {
    return fail(ErrorCode::kInvalidArgument, "the maps hold no positions to compare", "bake them with maps.positions");
  }
  if (!(factor > 0.0)) return fail(ErrorCode::kInvalidArgument, "a factor that is not above 0", "take 8");
  return Finder(maps, factor).find();
}

}  // namespace limn
