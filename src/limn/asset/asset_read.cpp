#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "limn/asset/asset_file.h"
#include "limn/asset/asset_layout.h"
#include "limn/asset/displacement_codec.h"
#include "limn/asset/leaf_codec.h"
#include "limn/asset/mesh_codec.h"
#include "limn/asset/range_coder.h"
#include "limn/base/file.h"
#include "limn/mesh/formats/gltf_document.h"
#include "limn/mesh/import.h"

namespace limn {
namespace {

using asset::kExtension;
using formats::gltf::Document;
using formats::gltf::Failure;
using formats::gltf::Field;
using formats::gltf::refuse;

constexpr std::string_view kAgain = "make the asset again: limn clip MODEL -o ASSET.glb";

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

float finite_float(const Field& field) {
  if (!field) refuse(field.path(), "is missing", std::string(kAgain));
  const double value = field.number_or(0.0);
  if (!(std::abs(value) <= std::numeric_limits<float>::max()))
    refuse(field.path(), "is beyond what a float holds", std::string(kAgain));
  return static_cast<float>(value);
}

Vec3 vector_of(const Field& field) {
  if (field.size() != 3) refuse(field.path(), "needs 3 numbers", std::string(kAgain));
  return Vec3(finite_float(field.at(0)), finite_float(field.at(1)), finite_float(field.at(2)));
}

/// The extension of a file that is whole and unaltered, and access to its parts.
class Reader {
 public:
  /// Throws Failure.
  Reader(const formats::Source& source, std::vector<std::string>& notes)
      : bytes_(source.bytes), document_(source, notes), extension_(document_["extensions"][kExtension]) {
    if (!extension_)
      refuse({}, "is no clip asset: it lacks the extension " + std::string(kExtension), std::string(kAgain));
    check_version();
    check_sum();
  }

  ClipAsset read(std::string_view name) {
    ClipAsset asset;
    asset.bounds = {vector_of(extension_["bounds"]["low"]), vector_of(extension_["bounds"]["high"])};
    if (asset.bounds.empty()) refuse(extension_["bounds"].path(), "are empty", std::string(kAgain));
    const Field levels = levels_field();
    for (std::size_t i = 0; i < levels.size(); ++i)
      asset.levels.push_back(read_level(levels.at(i), i == 0 ? 0.0f : asset.levels.back().error));
    read_hull(asset, name);
    read_maps(asset, name);
    return asset;
  }

  AssetBytes measure() {
    AssetBytes bytes;
    bytes.file = bytes_.size();
    const Field levels = levels_field();
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const Field level = levels.at(i);
      bytes.levels.push_back({static_cast<std::size_t>(level["faces"].index()), finite_float(level["error"]),
                              view(level["mesh"]).size(), level["search"] ? view(level["search"]).size() : 0});
    }
    const auto size_of = [this](const char* name) {
      const Field field = extension_[name]["bufferView"];
      return field ? view(field).size() : 0;
    };
    bytes.normals = size_of("normals");
    bytes.colors = size_of("colors");
    bytes.displacement = size_of("displacement");
    return bytes;
  }

 private:
  void check_version() const {
    const std::uint64_t version = extension_["version"].index();
    if (version == asset::kVersion) return;
    refuse(extension_["version"].path(), fmt::format("is {}; this program reads {}", version, asset::kVersion),
           std::string(kAgain));
  }

  void check_sum() const {
    const std::string_view file = as_text(bytes_);
    const std::optional<std::size_t> at = asset::find_checksum(file);
    if (!at) refuse(extension_.path(), "was written by another program", std::string(kAgain));
    if (file.substr(*at, asset::kNoChecksum.size()) != asset::checksum_of(file, *at))
      refuse(extension_["checksum"].path(), "does not match: the file was altered or damaged", std::string(kAgain));
  }

  Field levels_field() const {
    Field levels = extension_["levels"];
    if (levels.size() == 0 || levels.size() > asset::kMostLevels)
      refuse(levels.path(), fmt::format("must be 1 to {}, not {}", asset::kMostLevels, levels.size()),
             std::string(kAgain));
    return levels;
  }

  std::span<const std::byte> view(const Field& index) {
    return document_.view(index.index_into(document_["bufferViews"])).bytes;
  }

  /// Parts may be named more than once: all that they unfold to must be in proportion to the file.
  std::size_t claim(const Field& field) {
    const std::uint64_t count = field.index();
    // Vertices and faces each.
    if (count > 2 * asset::most_elements(bytes_.size()) - claimed_)
      refuse(field.path(), fmt::format("is {}, too many for a file of {} bytes", count, bytes_.size()),
             std::string(kAgain));
    claimed_ += static_cast<std::size_t>(count);
    return static_cast<std::size_t>(count);
  }

  SilhouetteLevel read_level(const Field& field, float error_before) {
    SilhouetteLevel level;
    const std::size_t vertices = claim(field["vertices"]), faces = claim(field["faces"]);
    std::optional<Mesh> mesh = asset::decode_mesh(view(field["mesh"]), vertices, faces);
    if (!mesh || mesh->faces.empty()) refuse(field["mesh"].path(), "holds no mesh of that size", std::string(kAgain));
    level.mesh = *std::move(mesh);
    level.error = finite_float(field["error"]);
    if (level.error < error_before) refuse(field["error"].path(), "is smaller than that before", std::string(kAgain));
    if (!field["search"]) return level;
    auto leaves = asset::decode_leaves(view(field["search"]), build_topology(level.mesh));
    if (!leaves) refuse(field["search"].path(), "holds no search tree of that mesh", std::string(kAgain));
    level.leaf_of_edge = *std::move(leaves);
    return level;
  }

  void read_hull(ClipAsset& asset, std::string_view name) const {
    Result<ImportedMesh> hull = read_mesh(bytes_, MeshFormat::kGlb, name);
    if (!hull) throw Failure{hull.error().where, hull.error().message, hull.error().remedy, hull.error().code};
    if (hull->mesh.faces.empty()) refuse("meshes", "hold no faces: there is no hull", std::string(kAgain));
    asset.hull = std::move(hull->mesh);
  }

  static Image decode(std::span<const std::byte> bytes, std::string_view name, const Field& field) {
    Result<Image> image = decode_image(bytes, name);
    if (!image) refuse(field.path(), image.error().message, std::string(kAgain));
    return *std::move(image);
  }

  void read_maps(ClipAsset& asset, std::string_view name) {
    const Field normals = extension_["normals"], colors = extension_["colors"];
    if (normals) asset.maps.normals = decode(view(normals["bufferView"]), name, normals);
    if (colors && colors["material"]) {
      if (colors["material"].index_into(document_["materials"]) >= asset.hull.materials.size())
        refuse(colors.path(), "name no material", std::string(kAgain));
      const Material& material = asset.hull.materials[colors["material"].index()];
      asset.maps.colors = decode(material.base_color_image, name, colors);
    } else if (colors) {
      asset.maps.colors = decode(view(colors["bufferView"]), name, colors);
    }
    if (const Field field = extension_["displacement"]) read_displacement(asset.maps, field);
  }

  void read_displacement(DetailMaps& maps, const Field& field) {
    const std::uint64_t width = field["width"].index(), height = field["height"].index();
    constexpr auto kMost = static_cast<std::uint64_t>(asset::kMostSide);
    if (width == 0 || height == 0 || width > kMost || height > kMost)
      refuse(field.path(), fmt::format("has {} x {} texels", width, height), std::string(kAgain));
    auto texels = asset::decode_texels(view(field["bufferView"]), static_cast<std::size_t>(width),
                                       static_cast<std::size_t>(height));
    if (!texels) refuse(field["bufferView"].path(), "holds no map of that size", std::string(kAgain));
    maps.displacement = *std::move(texels);
    maps.displacement_width = static_cast<int>(width);
    maps.displacement_height = static_cast<int>(height);
    maps.displacement_low = finite_float(field["low"]);
    maps.displacement_high = finite_float(field["high"]);
  }

  std::span<const std::byte> bytes_;
  Document document_;
  Field extension_;
  std::size_t claimed_ = 0;
};

/// Calls `use` with a reader; whatever is thrown becomes an error.
template <class Value, class Use>
Result<Value> with_reader(std::span<const std::byte> bytes, std::string_view name, const Use& use) try {
  const formats::Source source{.bytes = bytes, .name = std::string(name), .folder = {}, .progress = {}};
  std::vector<std::string> notes;
  Reader reader(source, notes);
  return use(reader);
} catch (const Failure& failure) {
  const std::string remedy = failure.remedy.empty() ? std::string(kAgain) : failure.remedy;
  return fail_at(ErrorCode::kUnreadable, std::string(name), failure.where, failure.message, remedy);
} catch (const std::bad_alloc&) {
  return fail_at(ErrorCode::kUnreadable, std::string(name), {}, "not enough memory for the asset");
} catch (const std::exception& error) {
  return fail_at(ErrorCode::kUnreadable, std::string(name), {}, error.what(), std::string(kAgain));
}

}  // namespace

Result<ClipAsset> read_clip_asset(std::span<const std::byte> bytes, std::string_view name) {
  return with_reader<ClipAsset>(bytes, name, [name](Reader& reader) { return reader.read(name); });
}

Result<ClipAsset> read_clip_asset(const std::filesystem::path& path) {
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return tl::unexpected(file.error());
  return read_clip_asset(file->bytes(), path == "-" ? "standard input" : path.string());
}

Result<AssetBytes> measure_clip_asset(std::span<const std::byte> bytes, std::string_view name) {
  return with_reader<AssetBytes>(bytes, name, [](Reader& reader) { return reader.measure(); });
}

bool holds_clip_asset(std::span<const std::byte> bytes) {
  const std::string_view file = as_text(bytes);
  if (!file.starts_with("glTF")) return false;
  // Quotes within strings are escaped: this is an extension's name, and no other text.
  return file.find("\"" + std::string(kExtension) + "\":{") != std::string_view::npos;
}

}  // namespace limn
