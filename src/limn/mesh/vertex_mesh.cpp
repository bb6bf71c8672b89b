#include "limn/mesh/vertex_mesh.h"

#include <cstdint>
#include <cstring>
#include <utility>

namespace limn {
namespace {

/// What one corner carries; attributes a mesh lacks stay zero.
struct CornerValues {
  Vec3 normal{0.0f};
  Vec2 uv{0.0f};
  Vec4 color{0.0f};
  Vec4 tangent{0.0f};
};
constexpr std::size_t kWords = 13;
static_assert(sizeof(CornerValues) == kWords * sizeof(float));

/// Bits, not values: -0 and 0 are kept apart, NaN equals itself.
bool same_bits(const CornerValues& a, const CornerValues& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

std::uint64_t hash_of(VertexId vertex, const CornerValues& values) {
  std::uint32_t words[kWords];
  std::memcpy(words, &values, sizeof values);
  std::uint64_t hash = vertex;
  for (const std::uint32_t word : words)
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull ^ (hash >> 29);
  return hash ^ (hash >> 32);
}

class VertexSplitter {
 public:
  explicit VertexSplitter(const Mesh& mesh) : mesh_(mesh) {
    const std::size_t count = mesh.positions.size();
    result_.positions = mesh.positions;
    result_.source.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      result_.source[i] = static_cast<VertexId>(i);
    // What no face uses still has to look like a vertex.
    if (!mesh.normals.empty()) result_.normals.assign(count, Vec3(0, 0, 1));
    if (!mesh.uvs.empty()) result_.uvs.assign(count, Vec2(0.0f));
    if (!mesh.colors.empty()) result_.colors.assign(count, Vec4(1.0f));
    if (!mesh.tangents.empty()) result_.tangents.assign(count, Vec4(1, 0, 0, 1));
    used_.assign(count, false);
  }

  VertexMesh split() {
    result_.faces.resize(mesh_.faces.size());
    for (FaceId face = 0; face < mesh_.faces.size(); ++face) {
      for (int c = 0; c < 3; ++c) {
        result_.faces[face][static_cast<std::size_t>(c)] =
            vertex_for(mesh_.faces[face][static_cast<std::size_t>(c)], values_at(face, c));
      }
    }
    return std::move(result_);
  }

 private:
  CornerValues values_at(FaceId face, int c) const {
    CornerValues values;
    if (!mesh_.normals.empty()) values.normal = mesh_.corner(mesh_.normals, face, c);
    if (!mesh_.uvs.empty()) values.uv = mesh_.corner(mesh_.uvs, face, c);
    if (!mesh_.colors.empty()) values.color = mesh_.corner(mesh_.colors, face, c);
    if (!mesh_.tangents.empty()) values.tangent = mesh_.corner(mesh_.tangents, face, c);
    return values;
  }

  CornerValues values_of(VertexId vertex) const {
    CornerValues values;
    if (!result_.normals.empty()) values.normal = result_.normals[vertex];
    if (!result_.uvs.empty()) values.uv = result_.uvs[vertex];
    if (!result_.colors.empty()) values.color = result_.colors[vertex];
    if (!result_.tangents.empty()) values.tangent = result_.tangents[vertex];
    return values;
  }

  void set(VertexId vertex, const CornerValues& values) {
    if (!result_.normals.empty()) result_.normals[vertex] = values.normal;
    if (!result_.uvs.empty()) result_.uvs[vertex] = values.uv;
    if (!result_.colors.empty()) result_.colors[vertex] = values.color;
    if (!result_.tangents.empty()) result_.tangents[vertex] = values.tangent;
  }

  /// The vertex at `position` with these values: the position itself for the first that come, a repeat for others.
  VertexId vertex_for(VertexId position, const CornerValues& values) {
    if (!used_[position]) {
      used_[position] = true;
      set(position, values);
      return position;
    }
    if (same_bits(values_of(position), values)) return position;
    if (2 * (repeats_ + 1) > table_.size()) grow();
    const std::size_t slot = find(position, values);
    if (table_[slot] == kInvalidId) table_[slot] = add_repeat(position, values);
    return table_[slot];
  }

  /// The slot that holds this repeat, or the free one where it belongs.
  std::size_t find(VertexId position, const CornerValues& values) const {
    std::size_t slot = hash_of(position, values) & (table_.size() - 1);
    while (table_[slot] != kInvalidId) {
      const VertexId vertex = table_[slot];
      if (result_.source[vertex] == position && same_bits(values_of(vertex), values)) break;
      slot = (slot + 1) & (table_.size() - 1);
    }
    return slot;
  }

  VertexId add_repeat(VertexId position, const CornerValues& values) {
    const auto vertex = static_cast<VertexId>(result_.positions.size());
    const Vec3 point = mesh_.positions[position];
    result_.positions.push_back(point);
    result_.source.push_back(position);
    if (!result_.normals.empty()) result_.normals.push_back(values.normal);
    if (!result_.uvs.empty()) result_.uvs.push_back(values.uv);
    if (!result_.colors.empty()) result_.colors.push_back(values.color);
    if (!result_.tangents.empty()) result_.tangents.push_back(values.tangent);
    ++repeats_;
    return vertex;
  }

  /// Doubles the table of repeats, a power of two that stays half empty.
  void grow() {
    const std::vector<VertexId> old = std::move(table_);
    table_.assign(old.empty() ? 1024 : 2 * old.size(), kInvalidId);
    for (const VertexId vertex : old) {
      if (vertex != kInvalidId) table_[find(result_.source[vertex], values_of(vertex))] = vertex;
    }
  }

  const Mesh& mesh_;
  VertexMesh result_;
  std::vector<bool> used_;
  std::vector<VertexId> table_;
  std::size_t repeats_ = 0;
};

template <class T>
bool one_a_vertex(const CornerAttribute<T>& attribute) {
  return attribute.empty() || attribute.indices.empty();
}

}  // namespace

VertexMesh one_value_per_vertex(const Mesh& mesh) {
  if (!one_a_vertex(mesh.normals) || !one_a_vertex(mesh.uvs) || !one_a_vertex(mesh.colors) ||
      !one_a_vertex(mesh.tangents)) {
    return VertexSplitter(mesh).split();
  }
  VertexMesh result{
      mesh.positions, mesh.normals.values, mesh.uvs.values, mesh.colors.values, mesh.tangents.values, mesh.faces, {}};
  result.source.resize(mesh.positions.size());
  for (std::size_t i = 0; i < result.source.size(); ++i)
    result.source[i] = static_cast<VertexId>(i);
  return result;
}

}  // namespace limn
