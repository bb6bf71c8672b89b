#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "limn/base/bounds.h"
#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// Values that belong to the corners of faces: normals, texture coordinates, colours.
///
/// With `indices` empty, a corner's value is values[position index] (one value a vertex, as in PLY and glTF);
/// else values[indices[3 * face + corner]] (as in OBJ). No values at all: the mesh does not have the attribute.
template <class T>
struct CornerAttribute {
  std::vector<T> values;
  std::vector<std::uint32_t> indices;

  bool empty() const { return values.empty(); }
};

/// What a renderer needs to know of a surface; read from and written to glTF, and MTL but for `double_sided` and
/// `normal_scale`.
struct Material {
  std::string name;
  Vec4 base_color{0.8f, 0.8f, 0.8f, 1.0f};  ///< linear, as in glTF
  float metallic = 0.0f;
  float roughness = 0.6f;
  bool double_sided = false;
  std::vector<std::byte> base_color_image;  ///< the encoded file (PNG or JPEG); empty for none
  std::string base_color_image_mime;        ///< "image/png" or "image/jpeg"
  /// A normal map as in glTF: x towards growing u, y towards the top of the picture, z off the surface.
  std::vector<std::byte> normal_image;  ///< the encoded file; empty for none
  std::string normal_image_mime;
  float normal_scale = 1.0f;  ///< of x and y
};

/// An indexed triangle mesh as a file gave it: positions in file order, connectivity not yet welded.
///
/// Connectivity is by position: build_topology() joins vertices of equal coordinates, so that a seam, where a format
/// splits vertices because normals or texture coordinates differ, is not taken for a boundary.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;    ///< indices into positions
  CornerAttribute<Vec3> normals;  ///< unit length
  CornerAttribute<Vec2> uvs;      ///< v upwards from the bottom of the picture, as in OBJ
  CornerAttribute<Vec4> colors;   ///< linear RGBA
  /// What a normal map was baked for: xyz of unit length along growing u, w the side of the bitangent (+1 or −1), as
  /// glTF's TANGENT. Written to glTF, read from nothing; dropped by whatever makes new surfaces.
  CornerAttribute<Vec4> tangents;
  std::vector<float> tags;  ///< one value a position, for Criterion::kTags (refine/levels.h); may be empty
  std::vector<std::uint32_t> face_materials;  ///< one a face, index into materials; empty: all of material 0, or none
  std::vector<Material> materials;

  std::size_t face_count() const { return faces.size(); }

  /// The value of an attribute at corner 0, 1 or 2 of a face. \pre !attribute.empty()
  template <class T>
  const T& corner(const CornerAttribute<T>& attribute, FaceId face, int c) const {
    return attribute.values[corner_index(attribute, face, c)];
  }

  /// The index of that value.
  template <class T>
  std::uint32_t corner_index(const CornerAttribute<T>& attribute, FaceId face, int c) const {
    return attribute.indices.empty()
               ? faces[face][static_cast<std::size_t>(c)]
               : attribute.indices[3 * static_cast<std::size_t>(face) + static_cast<std::size_t>(c)];
  }
};

/// The box of the vertices that faces use (stray vertices do not count); empty when there is no face.
Bounds face_bounds(const Mesh& mesh);

/// What limn draws a mesh without materials in: light clay, so that shape speaks; white where vertex colours speak.
Material plain_material(const Mesh& mesh);

}  // namespace limn
