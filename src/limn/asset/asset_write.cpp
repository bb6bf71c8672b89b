#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limn/asset/asset_file.h"
#include "limn/asset/asset_layout.h"
#include "limn/asset/displacement_codec.h"
#include "limn/asset/leaf_codec.h"
#include "limn/asset/mesh_codec.h"
#include "limn/base/file.h"
#include "limn/image/deep_image.h"
#include "limn/mesh/formats/formats.h"
#include "limn/silhouette/search/leaf_partition.h"

namespace limn {
namespace {

using Json = nlohmann::ordered_json;
using asset::kExtension;

Json vector_json(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  return {bytes.begin(), bytes.end()};
}

bool shows(const std::vector<std::byte>& encoded, const Image& image) {
  if (encoded.empty()) return false;
  const Result<Image> decoded = decode_image(encoded, "material");
  return decoded && decoded->width == image.width && decoded->height == image.height && decoded->rgba == image.rgba;
}

/// The extension's parts and its JSON, grown together; views are numbered from the first of them.
class Extension {
 public:
  Extension(const ClipAsset& asset, std::string file) : asset_(asset), file_(std::move(file)) {}

  Result<void> build() {
    const Vec3 &low = asset_.bounds.low, &high = asset_.bounds.high;
    json_ = {{"version", asset::kVersion}, {"checksum", asset::kNoChecksum}};
    json_["bounds"] = {{"low", vector_json(low)}, {"high", vector_json(high)}};
    if (!is_finite(low) || !is_finite(high) || asset_.bounds.empty()) return refuse("bounds", "are empty");
    if (asset_.hull.faces.empty()) return refuse("hull", "has no faces");
    if (asset_.levels.empty() || asset_.levels.size() > asset::kMostLevels)
      return refuse("levels", fmt::format("must be 1 to {}, not {}", asset::kMostLevels, asset_.levels.size()));
    for (std::size_t i = 0; i < asset_.levels.size(); ++i) {
      if (Result<void> added = add_level(i); !added) return added;
    }
    return add_picture("normals", asset_.maps.normals, bytes_.normals)
        .and_then([this] { return add_colors(); })
        .and_then([this] { return add_displacement(); });
  }

  formats::GltfExtension finish() {
    return {std::string(kExtension), std::move(views_), [this](std::size_t first) { return json_from(first).dump(); }};
  }
  const AssetBytes& bytes() const { return bytes_; }

 private:
  tl::unexpected<Error> refuse(std::string where, std::string message) const {
    return fail_at(ErrorCode::kInvalidArgument, file_, std::move(where), std::move(message));
  }

  std::size_t add_view(std::vector<std::byte> bytes, std::size_t& count) {
    count = bytes.size();
    views_.push_back(std::move(bytes));
    return views_.size() - 1;
  }

  Result<void> add_level(std::size_t i) {
    const SilhouetteLevel& level = asset_.levels[i];
    const std::string where = fmt::format("level {}", i);
    if (level.mesh.faces.empty()) return refuse(where, "has no faces");
    if (!std::all_of(level.mesh.positions.begin(), level.mesh.positions.end(), is_finite))
      return refuse(where, "has coordinates that are not finite");
    const float before = i == 0 ? 0.0f : asset_.levels[i - 1].error;
    if (!std::isfinite(level.error) || level.error < before) return refuse(where, "has a smaller error than before it");
    AssetBytes::Level& count = bytes_.levels.emplace_back();
    count.faces = level.mesh.faces.size();
    count.error = level.error;
    Json json = {{"vertices", level.mesh.positions.size()}, {"faces", count.faces}, {"error", level.error}};
    json["mesh"] = add_view(asset::encode_mesh(level.mesh), count.mesh);
    if (!level.leaf_of_edge.empty()) {
      const Topology topology = build_topology(level.mesh);
      if (!partition_clusters(level.leaf_of_edge, topology)) return refuse(where, "has a search tree of another mesh");
      json["search"] = add_view(asset::encode_leaves(level.leaf_of_edge, topology), count.search);
    }
    json_["levels"].push_back(std::move(json));
    return {};
  }

  Result<void> add_picture(const char* name, const Image& image, std::size_t& count) {
    if (image.rgba.empty()) return {};
    const bool sides =
        image.width > 0 && image.height > 0 && image.width <= asset::kMostSide && image.height <= asset::kMostSide;
    if (!sides || image.rgba.size() != Image(image.width, image.height).rgba.size())
      return refuse(name, fmt::format("are no picture of {} x {} texels", image.width, image.height));
    const Result<std::string> encoded = encode_png(image);
    if (!encoded) return refuse(name, encoded.error().message);
    json_[name] = {{"bufferView", add_view(bytes_of(*encoded), count)}};
    return {};
  }

  /// Most often the hull's material shows these very colours: then they are in the file once.
  Result<void> add_colors() {
    const Image& colors = asset_.maps.colors;
    const std::vector<Material>& materials = asset_.hull.materials;
    const bool shared = !colors.rgba.empty() && !materials.empty() && !asset_.hull.uvs.empty() &&
                        shows(materials[0].base_color_image, colors);
    if (!shared) return add_picture("colors", colors, bytes_.colors);
    json_["colors"] = {{"material", 0}};
    return {};
  }

  Result<void> add_displacement() {
    const DetailMaps& maps = asset_.maps;
    if (maps.displacement.empty()) return {};
    const int width = maps.displacement_width, height = maps.displacement_height;
    const bool sides = width > 0 && height > 0 && width <= asset::kMostSide && height <= asset::kMostSide &&
                       maps.displacement.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (!sides) return refuse("displacement", fmt::format("is no map of {} x {} texels", width, height));
    if (!std::isfinite(maps.displacement_low) || !std::isfinite(maps.displacement_high))
      return refuse("displacement", "has bounds that are not finite");
    const auto texels = asset::encode_texels(maps.displacement, static_cast<std::size_t>(width));
    json_["displacement"] = {{"bufferView", add_view(texels, bytes_.displacement)},
                             {"width", width},
                             {"height", height},
                             {"low", maps.displacement_low},
                             {"high", maps.displacement_high}};
    return {};
  }

  /// The JSON with buffer views as the file numbers them.
  Json json_from(std::size_t first) const {
    Json json = json_;
    const auto shift = [first](Json& field) { field = field.get<std::size_t>() + first; };
    for (Json& level : json["levels"]) {
      shift(level["mesh"]);
      if (level.contains("search")) shift(level["search"]);
    }
    for (const char* const name : {"normals", "colors", "displacement"}) {
      if (json.contains(name) && json[name].contains("bufferView")) shift(json[name]["bufferView"]);
    }
    return json;
  }

  const ClipAsset& asset_;
  std::string file_;
  Json json_;
  std::vector<std::vector<std::byte>> views_;
  AssetBytes bytes_;
};

Result<AssetBytes> write(const ClipAsset& asset, const std::filesystem::path& path) {
  Extension extension(asset, path.string());
  if (const Result<void> built = extension.build(); !built) return tl::unexpected(built.error());
  const formats::GltfExtension parts = extension.finish();
  Result<std::vector<formats::OutputFile>> files = formats::write_gltf(asset.hull, path, true, &parts);
  if (!files) return tl::unexpected(files.error());
  std::string& file = files->front().bytes;
  const std::optional<std::size_t> at = asset::find_checksum(file);
  if (!at) return fail_at(ErrorCode::kUnwritable, path.string(), {}, "the checksum has no place");
  file.replace(*at, asset::kNoChecksum.size(), asset::checksum_of(file, *at));
  AssetBytes bytes = extension.bytes();
  bytes.file = file.size();
  return write_file(path, file).map([&bytes] { return bytes; });
}

}  // namespace

std::size_t AssetBytes::rest() const {
  std::size_t rest = file - normals - colors - displacement;
  for (const Level& level : levels)
    rest -= level.mesh + level.search;
  return rest;
}

Result<AssetBytes> write_clip_asset(const ClipAsset& asset, const std::filesystem::path& path) try {
  return write(asset, path);
} catch (const std::bad_alloc&) {
  return fail_at(ErrorCode::kUnwritable, path.string(), {}, "not enough memory to write the asset");
} catch (const std::exception& error) {
  return fail_at(ErrorCode::kUnwritable, path.string(), {}, error.what());
}

}  // namespace limn
