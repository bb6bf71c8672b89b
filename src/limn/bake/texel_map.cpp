#include "limn/bake/texel_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <utility>

namespace limn::bake_detail {
namespace {

constexpr double kMostRepetitions = 8.0;
/// Twice the area, in square texels, below which a face has no texels of its own.
constexpr double kLeastArea = 1e-9;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Share of the segment from the origin along `edge` that is nearest to `from`.
float nearest_share(const Vec2& from, const Vec2& edge) {
  const float length = glm::dot(edge, edge);
  return length > 0.0f ? std::clamp(glm::dot(from, edge) / length, 0.0f, 1.0f) : 0.0f;
}

float squared(const Vec2& v) {
  return glm::dot(v, v);
}

/// A face's corners in texels, turned counter-clockwise so that its inside is where all edge functions are positive.
struct TexelTriangle {
  std::array<glm::dvec2, 3> corners;
  double area = 0;  ///< twice, positive

  explicit TexelTriangle(const glm::dvec2 (&from)[3]) : corners{from[0], from[1], from[2]} {
    area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (area < 0.0) {
      std::swap(corners[1], corners[2]);
      area = -area;
    }
  }

  /// How deep the place lies within, as the smallest edge function; `reach` widens each edge by what half a texel
  /// around the place may add.
  double depth(const glm::dvec2& place, double reach) const {
    double least = 1e300;
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::dvec2 edge = corners[(c + 1) % 3] - corners[c];
      const double widened = reach * (std::abs(edge.x) + std::abs(edge.y));
      least = std::min(least, cross(edge, place - corners[c]) + widened);
    }
    return least;
  }
};

class Rasterizer {
 public:
  Rasterizer(const Mesh& mesh, int size_px) : mesh_(mesh), size_(size_px) {
    const auto size = static_cast<std::size_t>(size_px);
    map_.size_px = size_px;
    map_.wraps = true;
    map_.owner.assign(size * size, kInvalidId);
    map_.frames.resize(mesh.faces.size());
    crowded_.assign(size * size, false);
  }

  Result<TexelMap> run(int gutter_px) {
    for (FaceId face = 0; face < mesh_.faces.size(); ++face) {
      if (Result<void> good = check(face); !good) return tl::unexpected(good.error());
      glm::dvec2 corners[3];
      corners_of(face, corners);
      map_.frames[face] = TexelFrame(corners);
      cover(face, TexelTriangle(corners), 0.0);
    }
    for (FaceId face = 0; face < mesh_.faces.size(); ++face) {
      glm::dvec2 corners[3];
      corners_of(face, corners);
      cover(face, TexelTriangle(corners), 0.5);
    }
    map_.overlapping = static_cast<std::size_t>(std::count(crowded_.begin(), crowded_.end(), true));
    grow(gutter_px);
    return std::move(map_);
  }

 private:
  void corners_of(FaceId face, glm::dvec2 (&corners)[3]) const {
    for (int c = 0; c < 3; ++c) {
      const glm::dvec2 uv(mesh_.corner(mesh_.uvs, face, c));
      corners[c] = glm::dvec2(uv.x, 1.0 - uv.y) * double(size_);
    }
  }

  Result<void> check(FaceId face) const {
    glm::dvec2 low(1e300), high(-1e300);
    for (int c = 0; c < 3; ++c) {
      const glm::dvec2 uv(mesh_.corner(mesh_.uvs, face, c));
      // The largest float that still names a texel.
      if (!(std::abs(uv.x) < 1000.0 && std::abs(uv.y) < 1000.0)) {
        return fail_at(ErrorCode::kUnsuitable, {}, fmt::format("face {}", face),
                       "its texture coordinates are not finite or beyond 1000", "unwrap the mesh again, or use tiles");
      }
      low = glm::min(low, uv);
      high = glm::max(high, uv);
    }
    if (high.x - low.x <= kMostRepetitions && high.y - low.y <= kMostRepetitions) return {};
    return fail_at(ErrorCode::kUnsuitable, {}, fmt::format("face {}", face),
                   fmt::format("it spans more than {} repetitions of the picture", kMostRepetitions),
                   "unwrap the mesh again, or use tiles");
  }

  std::size_t index_of(int x, int y) const {
    const int column = (x % size_ + size_) % size_, row = (y % size_ + size_) % size_;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(column);
  }

  /// Texels whose centre lies within (reach 0), or whose square the face touches (reach ½; free ones only).
  void cover(FaceId face, const TexelTriangle& triangle, double reach) {
    if (triangle.area < kLeastArea) return;
    glm::dvec2 low = triangle.corners[0], high = low;
    for (const glm::dvec2& corner : triangle.corners) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    const auto first = [&](double at) { return static_cast<int>(std::ceil(at - 0.5 - reach)); };
    const auto last = [&](double at) { return static_cast<int>(std::floor(at - 0.5 + reach)); };
    const double inside = 1e-9 * double(size_);
    for (int y = first(low.y); y <= last(high.y); ++y) {
      for (int x = first(low.x); x <= last(high.x); ++x) {
        const double depth = triangle.depth(glm::dvec2(x + 0.5, y + 0.5), reach);
        if (reach > 0.0 ? depth <= inside : depth < 0.0) continue;
        const std::size_t texel = index_of(x, y);
        const bool taken = map_.owner[texel] != kInvalidId;
        if (!taken) map_.owner[texel] = face;
        if (taken && reach == 0.0 && depth > inside) crowded_[texel] = true;
      }
    }
  }

  /// Texel by texel outwards, over sides before corners; a texel takes the face of the first such neighbour.
  void grow(int rounds) {
    constexpr std::array<std::array<int, 2>, 8> kNeighbours{
        {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
    std::vector<std::pair<std::size_t, FaceId>> grown;
    for (int round = 0; round < rounds; ++round) {
      grown.clear();
      for (int y = 0; y < size_; ++y) {
        for (int x = 0; x < size_; ++x) {
          if (map_.owner[index_of(x, y)] != kInvalidId) continue;
          for (const auto& [dx, dy] : kNeighbours) {
            // Nothing grows over the picture's border: the other side is another island.
            if (x + dx < 0 || x + dx >= size_ || y + dy < 0 || y + dy >= size_) continue;
            const FaceId face = map_.owner[index_of(x + dx, y + dy)];
            if (face == kInvalidId) continue;
            grown.emplace_back(index_of(x, y), face);
            break;
          }
        }
      }
      if (grown.empty()) break;
      for (const auto& [texel, face] : grown)
        map_.owner[texel] = face;
    }
  }

  const Mesh& mesh_;
  int size_;
  TexelMap map_;
  std::vector<bool> crowded_;
};

}  // namespace

TexelFrame::TexelFrame(const glm::dvec2 (&corners)[3])
    : corner_(corners[0]), edge_1_(corners[1] - corners[0]), edge_2_(corners[2] - corners[0]) {
  const glm::dvec2 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const double area = cross(e1, e2);
  if (std::abs(area) < kLeastArea) return;
  u_gradient_ = Vec2(glm::dvec2(e2.y, -e2.x) / area);
  v_gradient_ = Vec2(glm::dvec2(-e1.y, e1.x) / area);
}

Barycentric TexelFrame::at(float x, float y) const {
  const Vec2 from = Vec2(x, y) - corner_;
  const float u = glm::dot(from, u_gradient_), v = glm::dot(from, v_gradient_);
  if (u >= 0.0f && v >= 0.0f && u + v <= 1.0f) return {u, v};
  return at_border(from);
}

bool TexelFrame::holds(float x, float y) const {
  const Vec2 from = Vec2(x, y) - corner_;
  const float u = glm::dot(from, u_gradient_), v = glm::dot(from, v_gradient_);
  return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && area() > 0.0;
}

double TexelFrame::area() const {
  return std::abs(cross(glm::dvec2(edge_1_), glm::dvec2(edge_2_))) * 0.5;
}

Barycentric TexelFrame::at_border(Vec2 from) const {
  const float t1 = nearest_share(from, edge_1_), t2 = nearest_share(from, edge_2_);
  const float t3 = nearest_share(from - edge_1_, edge_2_ - edge_1_);
  const float d1 = squared(from - t1 * edge_1_), d2 = squared(from - t2 * edge_2_);
  const float d3 = squared(from - edge_1_ - t3 * (edge_2_ - edge_1_));
  if (d1 <= d2 && d1 <= d3) return {t1, 0.0f};
  if (d2 <= d3) return {0.0f, t2};
  return {1.0f - t3, t3};
}

Result<TexelMap> uv_texels(const Mesh& mesh, int size_px, int gutter_px) {
  return Rasterizer(mesh, size_px).run(gutter_px);
}

}  // namespace limn::bake_detail
