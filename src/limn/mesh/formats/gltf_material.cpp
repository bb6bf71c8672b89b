#include "limn/mesh/formats/gltf_material.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <set>
#include <utility>

#include "limn/mesh/formats/picture_bytes.h"

namespace limn::formats::gltf {
namespace {

float unit_interval(const Field& field, double otherwise) {
  return static_cast<float>(std::clamp(field.number_or(otherwise), 0.0, 1.0));
}

float finite_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

/// Decides which materials get a copy of their picture.
class Copies {
 public:
  explicit Copies(const Document& document) : document_(document) {}

  bool take(std::size_t image, std::size_t size) {
    // Images may share their bytes, and the first uses of all of them are free only as far as there are bytes.
    if (seen_.insert(image).second && size <= document_.bytes_read() - first_uses_) {
      first_uses_ += size;
      return true;
    }
    return budget_.take_copy(size);
  }

 private:
  const Document& document_;
  std::set<std::size_t> seen_;
  std::uint64_t first_uses_ = 0;
  PictureBudget budget_;
};

/// The encoded picture that a texture shows, and its type; empty, with a note, for one that cannot be used.
struct OwnPicture {
  std::vector<std::byte> bytes;
  std::string mime;
};

OwnPicture read_picture(Document& document, const Field& texture_info, Copies& copies) {
  const std::size_t texture = texture_info["index"].index_into(document["textures"]);
  if (texture_info["texCoord"].index_or(0) != 0 ||
      texture_info["extensions"]["KHR_texture_transform"]["texCoord"].index_or(0) != 0) {
    document.note(fmt::format("{} left out: it uses other texture coordinates than TEXCOORD_0", texture_info.path()));
    return {};
  }
  if (texture_info["extensions"]["KHR_texture_transform"]) document.note("texture transforms left out");
  const Field source = document["textures"].at(texture)["source"];
  if (!source) {
    document.note(fmt::format("{} left out: it has no PNG or JPEG source", texture_info.path()));
    return {};
  }
  const std::size_t image = source.index_into(document["images"]);
  const Picture picture = document.picture(image);
  if (!copies.take(image, picture.bytes.size())) {
    document.note(fmt::format("{} left out: its picture is used too many times", texture_info.path()));
    return {};
  }
  return {{picture.bytes.begin(), picture.bytes.end()}, picture.mime};
}

void read_base_color_picture(Document& document, const Field& texture_info, Material& material, Copies& copies) {
  OwnPicture picture = read_picture(document, texture_info, copies);
  material.base_color_image = std::move(picture.bytes);
  material.base_color_image_mime = std::move(picture.mime);
}

void read_normal_picture(Document& document, const Field& texture_info, Material& material, Copies& copies) {
  OwnPicture picture = read_picture(document, texture_info, copies);
  if (picture.bytes.empty()) return;
  material.normal_image = std::move(picture.bytes);
  material.normal_image_mime = std::move(picture.mime);
  material.normal_scale = finite_float(texture_info["scale"].number_or(1.0));
}

}  // namespace

Material default_material() {
  Material material;
  material.base_color = Vec4(1.0f);
  material.metallic = 1.0f;
  material.roughness = 1.0f;
  return material;
}

std::vector<Material> read_materials(Document& document) {
  std::vector<Material> materials;
  Copies copies(document);
  const Field list = document["materials"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Field field = list.at(i);
    const Field pbr = field["pbrMetallicRoughness"];
    Material material = default_material();
    material.name = field["name"].string_or("");
    if (const auto color = pbr["baseColorFactor"].numbers<4>()) {
      for (int c = 0; c < 4; ++c) {
        material.base_color[c] = static_cast<float>(std::clamp((*color)[static_cast<std::size_t>(c)], 0.0, 1.0));
      }
    }
    material.metallic = unit_interval(pbr["metallicFactor"], 1.0);
    material.roughness = unit_interval(pbr["roughnessFactor"], 1.0);
    material.double_sided = field["doubleSided"].boolean_or(false);
    if (const Field texture = pbr["baseColorTexture"]) read_base_color_picture(document, texture, material, copies);
    if (const Field texture = field["normalTexture"]) read_normal_picture(document, texture, material, copies);
    materials.push_back(std::move(material));
  }
  return materials;
}

}  // namespace limn::formats::gltf
