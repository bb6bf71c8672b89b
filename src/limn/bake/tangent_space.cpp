#include "limn/bake/tangent_space.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>

namespace limn::bake_detail {
namespace {

/// Everything is float, and "zero" is what the reference takes for it, so that both agree in doubtful cases.
bool not_zero(float value) {
  return std::abs(value) > std::numeric_limits<float>::min();
}
bool not_zero(const Vec3& v) {
  return not_zero(v.x) || not_zero(v.y) || not_zero(v.z);
}
Vec3 unit(const Vec3& v) {
  return not_zero(v) ? (1.0f / std::sqrt(glm::dot(v, v))) * v : v;
}
/// Without its part along n, of unit length.
Vec3 projected(const Vec3& v, const Vec3& n) {
  return unit(v - n * glm::dot(n, v));
}

/// What a corner is joined by.
struct CornerKey {
  std::array<std::uint32_t, 8> words;
  bool operator==(const CornerKey& other) const { return words == other.words; }
};
struct CornerHash {
  std::size_t operator()(const CornerKey& key) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : key.words)
      hash = (hash ^ word) * 0x9e3779b97f4a7c15ull ^ (hash >> 29);
    return static_cast<std::size_t>(hash ^ (hash >> 32));
  }
};

/// A face's own tangents and what they are worth.
struct FaceTangents {
  Vec3 along_u{0}, along_v{0};
  bool keeps_winding = false;  ///< counter-clockwise in the picture as well
  bool joins_any = true;       ///< no extent in the picture
  bool degenerate = false;     ///< two corners at one point
};

constexpr std::uint32_t kNone = kInvalidId;

class MikkTangents {
 public:
  MikkTangents(const Mesh& mesh, const CornerAttribute<Vec3>& normals) : mesh_(mesh) {
    const std::size_t corners = 3 * mesh.faces.size();
    normal_.resize(corners);
    uv_.resize(corners);
    for (FaceId face = 0; face < mesh.faces.size(); ++face) {
      for (int c = 0; c < 3; ++c) {
        const std::size_t corner = 3 * std::size_t{face} + static_cast<std::size_t>(c);
        normal_[corner] = mesh.corner(normals, face, c);
        uv_[corner] = mesh.corner(mesh.uvs, face, c);
      }
    }
  }

  std::vector<Vec4> run() {
    join_corners();
    measure_faces();
    find_neighbours();
    tangents_.assign(point_.size(), Vec4(1, 0, 0, -1));
    group_.assign(point_.size(), kNone);
    for (std::uint32_t corner = 0; corner < point_.size(); ++corner) {
      const FaceTangents& face = faces_[corner / 3];
      if (!face.degenerate && !face.joins_any && group_[corner] == kNone) form_group(corner);
    }
    fill_degenerate();
    return std::move(tangents_);
  }

 private:
  Vec3 position(std::uint32_t corner) const { return mesh_.positions[mesh_.faces[corner / 3][corner % 3]]; }

  void join_corners() {
    std::unordered_map<CornerKey, std::uint32_t, CornerHash> known;
    known.reserve(normal_.size());
    point_.resize(normal_.size());
    for (std::uint32_t corner = 0; corner < point_.size(); ++corner) {
      const Vec3 p = position(corner), n = normal_[corner];
      const float values[8] = {p.x, p.y, p.z, n.x, n.y, n.z, uv_[corner].x, uv_[corner].y};
      CornerKey key{};
      for (std::size_t i = 0; i < 8; ++i)
        key.words[i] = std::bit_cast<std::uint32_t>(values[i] == 0.0f ? 0.0f : values[i]);
      point_[corner] = known.emplace(key, corner).first->second;
    }
  }

  void measure_faces() {
    faces_.resize(mesh_.faces.size());
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      faces_[f] = measured(3 * f);
  }

  FaceTangents measured(std::uint32_t first) const {
    FaceTangents face;
    const Vec3 p0 = position(first), p1 = position(first + 1), p2 = position(first + 2);
    face.degenerate = p0 == p1 || p0 == p2 || p1 == p2;
    const Vec3 d1 = p1 - p0, d2 = p2 - p0;
    const Vec2 t1 = uv_[first + 1] - uv_[first], t2 = uv_[first + 2] - uv_[first];
    const float area = t1.x * t2.y - t1.y * t2.x;
    const Vec3 along_u = t2.y * d1 - t1.y * d2, along_v = -t2.x * d1 + t1.x * d2;
    face.keeps_winding = area > 0.0f;
    if (!not_zero(area)) return face;
    const float size = std::abs(area);
    const float length_u = std::sqrt(glm::dot(along_u, along_u)), length_v = std::sqrt(glm::dot(along_v, along_v));
    const float sign = face.keeps_winding ? 1.0f : -1.0f;
    if (not_zero(length_u)) face.along_u = (sign / length_u) * along_u;
    if (not_zero(length_v)) face.along_v = (sign / length_v) * along_v;
    face.joins_any = !(not_zero(length_u / size) && not_zero(length_v / size));
    return face;
  }

  /// Each edge with the first one that runs the other way between the same points and is not taken yet.
  void find_neighbours() {
    struct Side {
      std::uint32_t low, high, corner;
    };
    std::vector<Side> sides;
    for (std::uint32_t corner = 0; corner < point_.size(); ++corner) {
      if (faces_[corner / 3].degenerate) continue;
      const std::uint32_t a = point_[corner], b = point_[next(corner)];
      sides.push_back({std::min(a, b), std::max(a, b), corner});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::array{a.low, a.high, a.corner} < std::array{b.low, b.high, b.corner};
    });
    across_.assign(point_.size(), kNone);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const std::uint32_t corner = sides[i].corner;
      if (across_[corner] != kNone) continue;
      for (std::size_t j = i + 1; j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high;
           ++j) {
        const std::uint32_t other = sides[j].corner;
        if (across_[other] != kNone || point_[other] != point_[next(corner)]) continue;
        across_[corner] = other;
        across_[other] = corner;
        break;
      }
    }
  }

  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static std::uint32_t previous(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

  /// Whether a corner may join: it is free and its face winds as the group does. The first group that reaches a face
  /// without extent in the picture decides how it winds.
  bool takes(std::uint32_t corner, bool keeps_winding) {
    if (group_[corner] != kNone) return false;
    FaceTangents& face = faces_[corner / 3];
    const std::uint32_t first = corner - corner % 3;
    const bool untouched = group_[first] == kNone && group_[first + 1] == kNone && group_[first + 2] == kNone;
    if (face.joins_any && untouched) face.keeps_winding = keeps_winding;
    return face.keeps_winding == keeps_winding;
  }

  /// The corner at the same point in the face across the edge that leaves, or arrives at, this corner.
  std::uint32_t neighbour(std::uint32_t corner, bool leaving) const {
    const std::uint32_t other = across_[leaving ? corner : previous(corner)];
    if (other == kNone) return kNone;
    return leaving ? next(other) : other;
  }

  /// Depth first, the leaving edge first, as the order decides for faces that may join either kind.
  void form_group(std::uint32_t start) {
    const bool keeps_winding = faces_[start / 3].keeps_winding;
    std::vector<std::uint32_t> members, waiting{start};
    while (!waiting.empty()) {
      const std::uint32_t corner = waiting.back();
      waiting.pop_back();
      if (corner == kNone || !takes(corner, keeps_winding)) continue;
      group_[corner] = start;
      members.push_back(corner);
      waiting.push_back(neighbour(corner, false));
      waiting.push_back(neighbour(corner, true));
    }
    std::sort(members.begin(), members.end());
    const std::vector<Part> parts = parts_of(members);
    for (std::size_t i = 0; i < members.size(); ++i)
      tangents_[members[i]] = Vec4(mean_tangent(parts, i), keeps_winding ? 1.0f : -1.0f);
  }

  /// A face's tangents about a point's normal, and their weight there.
  struct Part {
    Vec3 along_u{0}, along_v{0};
    float weight = 0;
    bool joins_any = false;
  };

  std::vector<Part> parts_of(const std::vector<std::uint32_t>& members) const {
    std::vector<Part> parts;
    parts.reserve(members.size());
    for (const std::uint32_t corner : members) {
      const FaceTangents& face = faces_[corner / 3];
      const Vec3 n = normal_[corner];
      parts.push_back({projected(face.along_u, n), projected(face.along_v, n),
                       face.joins_any ? 0.0f : angle_at(corner, n), face.joins_any});
    }
    return parts;
  }

  /// Of the parts that are not exactly opposite to part `own`.
  static Vec3 mean_tangent(const std::vector<Part>& parts, std::size_t own) {
    Vec3 sum(0.0f);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].joins_any) continue;
      const bool alike = parts[own].joins_any || i == own ||
                         (glm::dot(parts[own].along_u, parts[i].along_u) > -1.0f &&
                          glm::dot(parts[own].along_v, parts[i].along_v) > -1.0f);
      if (alike) sum += parts[i].weight * parts[i].along_u;
    }
    return unit(sum);
  }

  /// The angle at the corner, seen along the normal.
  float angle_at(std::uint32_t corner, const Vec3& n) const {
    const Vec3 at = position(corner);
    const Vec3 back = projected(position(previous(corner)) - at, n), ahead = projected(position(next(corner)) - at, n);
    return static_cast<float>(std::acos(static_cast<double>(std::clamp(glm::dot(back, ahead), -1.0f, 1.0f))));
  }

  void fill_degenerate() {
    std::unordered_map<std::uint32_t, std::uint32_t> known;
    for (std::uint32_t corner = 0; corner < point_.size(); ++corner) {
      if (!faces_[corner / 3].degenerate) known.emplace(point_[corner], corner);
    }
    for (std::uint32_t corner = 0; corner < point_.size(); ++corner) {
      if (!faces_[corner / 3].degenerate) continue;
      const auto found = known.find(point_[corner]);
      if (found != known.end()) tangents_[corner] = tangents_[found->second];
    }
  }

  const Mesh& mesh_;
  std::vector<Vec3> normal_;
  std::vector<Vec2> uv_;
  std::vector<std::uint32_t> point_;  ///< one a corner: the first corner that equals it
  std::vector<FaceTangents> faces_;
  std::vector<std::uint32_t> across_;  ///< one a corner: the corner at which the same edge begins in the other face
  std::vector<std::uint32_t> group_;   ///< one a corner: the corner its group began with
  std::vector<Vec4> tangents_;
};

}  // namespace

std::vector<Vec4> mikk_tangents(const Mesh& mesh, const CornerAttribute<Vec3>& normals) {
  return MikkTangents(mesh, normals).run();
}

TangentFrame interpolated_frame(const Vec4 (&tangents)[3], const Vec3 (&normals)[3], float u, float v) {
  const float w = 1.0f - u - v;
  const Vec4 tangent = tangents[0] * w + tangents[1] * u + tangents[2] * v;
  TangentFrame frame;
  frame.tangent = Vec3(tangent);
  frame.normal = normals[0] * w + normals[1] * u + normals[2] * v;
  frame.bitangent = (tangent.w < 0.0f ? -1.0f : 1.0f) * glm::cross(frame.normal, frame.tangent);
  return frame;
}

Vec3 into_frame(const TangentFrame& frame, const Vec3& n) {
  const Vec3 across = glm::cross(frame.bitangent, frame.normal);
  const float volume = glm::dot(frame.tangent, across);
  if (!(std::abs(volume) > 1e-12f)) return {0, 0, 1};
  const Vec3 t = Vec3(glm::dot(n, across), glm::dot(n, glm::cross(frame.normal, frame.tangent)),
                      glm::dot(n, glm::cross(frame.tangent, frame.bitangent))) /
                 volume;
  const float length = glm::dot(t, t);
  return length > 0.0f && std::isfinite(length) ? t / std::sqrt(length) : Vec3(0, 0, 1);
}

Vec3 out_of_frame(const TangentFrame& frame, const Vec3& t) {
  return glm::normalize(t.x * frame.tangent + t.y * frame.bitangent + t.z * frame.normal);
}

}  // namespace limn::bake_detail
