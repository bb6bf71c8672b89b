#include "limn/render/materials.h"

#include <algorithm>
#include <bit>
#include <epoxy/gl.h>
#include <new>
#include <string>
#include <string_view>
#include <unordered_map>

#include "limn/image/image.h"
#include "limn/image/resample.h"

namespace limn {
namespace {

constexpr unsigned kTableBinding = 7;
constexpr unsigned kBaseColorUnit = 14;
constexpr unsigned kNormalUnit = 15;
constexpr std::size_t kMostTexels = std::size_t{1} << 28;  // of an array: 1 GiB without its mipmaps

tl::unexpected<Error> out_of_memory(std::size_t pictures) {
  return fail(ErrorCode::kNoGraphics,
              "the graphics device cannot hold the materials' " + std::to_string(pictures) + " different pictures",
              "use fewer or smaller ones");
}

int limit_of(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

/// Gathers pictures, each once, and makes an array of them.
class PictureArray {
 public:
  PictureArray(Channels channels, std::string what) : channels_(channels), what_(std::move(what)) {}

  /// The layer that the encoded picture will have; -1 for none. \pre the bytes stay until upload()
  std::int32_t add(const std::vector<std::byte>& bytes, const Material& material) {
    if (bytes.empty()) return -1;
    const std::string_view key(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto [known, added] = layers_.try_emplace(key, static_cast<std::int32_t>(sources_.size()));
    if (added) sources_.push_back({&bytes, &material});
    return known->second;
  }

  /// The array; no object without pictures.
  Result<gl::Texture> upload() const {
    if (sources_.empty()) return gl::Texture();
    if (sources_.size() > static_cast<std::size_t>(limit_of(GL_MAX_ARRAY_TEXTURE_LAYERS)))
      return out_of_memory(sources_.size());
    auto pictures = decode();
    if (!pictures) return tl::unexpected(pictures.error());
    int width = 1, height = 1;
    for (const Image& picture : *pictures) {
      width = std::max(width, picture.width);
      height = std::max(height, picture.height);
    }
    shrink(width, height);
    const int levels = std::bit_width(static_cast<unsigned>(std::max(width, height)));
    const unsigned format = channels_ == Channels::kSrgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
    gl::Texture array = gl::make_texture_array(format, {width, height, static_cast<int>(sources_.size())}, levels);
    if (gl::take_out_of_memory()) return out_of_memory(sources_.size());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (std::size_t layer = 0; layer < pictures->size(); ++layer) {
      const Image image = resample((*pictures)[layer], width, height, channels_);
      (*pictures)[layer] = Image();
      glTextureSubImage3D(array.id(), 0, 0, 0, static_cast<GLint>(layer), width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                          image.rgba.data());
    }
    glGenerateTextureMipmap(array.id());
    glTextureParameteri(array.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(array.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    if (gl::take_out_of_memory()) return out_of_memory(sources_.size());
    return array;
  }

 private:
  struct Source {
    const std::vector<std::byte>* bytes;
    const Material* material;  ///< the first that has it, for messages
  };

  /// Halves the longer side until a layer of that size is no more than its share.
  void shrink(int& width, int& height) const {
    const int longest = limit_of(GL_MAX_TEXTURE_SIZE);
    const std::size_t share = kMostTexels / sources_.size();
    while (std::max(width, height) > longest ||
           static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > share) {
      int& side = width > height ? width : height;
      side = std::max(side / 2, 1);
    }
  }

  /// All pictures, none larger than a layer may be: a few bytes can stand for a picture of a gigabyte.
  Result<std::vector<Image>> decode() const {
    std::vector<Image> pictures;
    pictures.reserve(sources_.size());
    for (const Source& source : sources_) {
      auto image = decode_image(*source.bytes, "material \"" + source.material->name + "\"");
      if (!image) {
        Error error = image.error();
        error.code = ErrorCode::kUnsuitable;
        error.message = "its " + what_ + " picture: " + error.message;
        return tl::unexpected(std::move(error));
      }
      int width = image->width, height = image->height;
      shrink(width, height);
      const bool fits = width == image->width && height == image->height;
      pictures.push_back(fits ? std::move(*image) : resample(*image, width, height, channels_));
    }
    return pictures;
  }

  Channels channels_;
  std::string what_;
  std::unordered_map<std::string_view, std::int32_t> layers_;
  std::vector<Source> sources_;
};

}  // namespace

MaterialTable::Entry MaterialTable::entry_of(const Material& material) {
  Entry entry;
  entry.base_color = Vec3(material.base_color);
  entry.metallic = material.metallic;
  entry.roughness = material.roughness;
  entry.normal_scale = material.normal_scale;
  return entry;
}

void MaterialTable::set_single(const gl::Program& program) const {
  program.set("single_material.base_color", first_entry_.base_color);
  program.set("single_material.metallic", first_entry_.metallic);
  program.set("single_material.roughness", first_entry_.roughness);
  program.set("single_material.base_color_layer", first_entry_.base_color_layer);
  program.set("single_material.normal_layer", first_entry_.normal_layer);
  program.set("single_material.normal_scale", first_entry_.normal_scale);
}

Result<MaterialTable> MaterialTable::create(std::span<const Mesh* const> meshes) try {
  gl::take_out_of_memory();
  MaterialTable table;
  std::vector<Entry> entries;
  PictureArray base_colors(Channels::kSrgb, "base colour"), normals(Channels::kLinear, "normal");
  for (const Mesh* const mesh : meshes) {
    table.first_.push_back(static_cast<std::uint32_t>(entries.size()));
    if (mesh->materials.empty()) entries.push_back(entry_of(plain_material(*mesh)));
    for (const Material& material : mesh->materials) {
      Entry& entry = entries.emplace_back(entry_of(material));
      if (mesh->uvs.empty()) continue;
      entry.base_color_layer = base_colors.add(material.base_color_image, material);
      entry.normal_layer = normals.add(material.normal_image, material);
    }
  }
  table.count_ = entries.size();
  if (!entries.empty()) table.first_entry_ = entries.front();
  table.table_ = gl::make_buffer_of(std::span<const Entry>(entries));
  auto base_color_array = base_colors.upload();
  if (!base_color_array) return tl::unexpected(base_color_array.error());
  table.base_colors_ = std::move(*base_color_array);
  auto normal_array = normals.upload();
  if (!normal_array) return tl::unexpected(normal_array.error());
  table.normals_ = std::move(*normal_array);
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory for " + std::to_string(table.count_) + " materials");
  }
  return table;
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::kNoGraphics, "not enough memory for the materials' pictures", "use fewer or smaller ones");
}

Result<MaterialTable> MaterialTable::create(const Mesh& mesh) {
  const Mesh* const meshes[] = {&mesh};
  return create(meshes);
}

void MaterialTable::bind() const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kTableBinding, table_.id());
  glBindTextureUnit(kBaseColorUnit, base_colors_.id());
  glBindTextureUnit(kNormalUnit, normals_.id());
}

}  // namespace limn
