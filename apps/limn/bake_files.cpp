#include "bake_files.h"

#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limn/base/file.h"
#include "limn/mesh/export.h"

#include "interrupt.h"
#include "mesh_files.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

/// A map, the file it goes into and how its values are stored there.
struct MapFile {
  const char* name;
  const FloatImage* image;
  ChannelCoding coding;
  bool precise = false;  ///< 16 bits at least
};

std::vector<MapFile> map_files(const BakedMaps& maps) {
  std::vector<MapFile> files;
  const auto add = [&](MapFile file) {
    if (!file.image->empty()) files.push_back(file);
  };
  add({"normal", &maps.tangent_normals, kVectorCoding});
  add({"normal_object", &maps.object_normals, kVectorCoding});
  add({"color", &maps.colors, kColorCoding});
  const ChannelCoding range{static_cast<float>(maps.report.displacement_low),
                            static_cast<float>(maps.report.displacement_high), false};
  add({"displacement", &maps.displacement, range, true});
  add({"occlusion", &maps.occlusion, kShareCoding});
  return files;
}

Result<std::string> encoded(const MapFile& file, int depth) {
  if (depth == 32) return encode_exr(*file.image);
  if (depth == 16 || file.precise) return encode_png(to_16_bit(*file.image, file.coding));
  return encode_png(to_8_bit(*file.image, file.coding));
}

/// What the stored values mean.
ordered_json described(const MapFile& file, const std::string& name, int depth) {
  ordered_json json{{"file", name}, {"channels", file.image->channels}};
  if (depth == 32) {
    json["values"] = "as they are";
    return json;
  }
  json["low"] = file.coding.low;
  json["high"] = file.coding.high;
  json["srgb"] = file.coding.srgb;
  return json;
}

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (std::filesystem::is_directory(folder)) return {};
  return fail_at(ErrorCode::kUnwritable, folder.string(), {}, "is no folder, and none can be made there",
                 "choose another place, or name a .glb file");
}

Result<std::vector<std::string>> write_model(const BakedMaps& maps, const BakeFileOptions& options) {
  BakedMaterialOptions material;
  material.deep = options.depth == 16;
  const Result<Mesh> mesh = mesh_with_maps(maps, material);
  if (!mesh) return tl::unexpected(mesh.error());
  return write_mesh(*mesh, options.path).map([&] { return std::vector<std::string>{options.path}; });
}

Result<std::vector<std::string>> write_folder(const BakedMaps& maps, const BakeFileOptions& options) {
  const std::filesystem::path folder(options.path);
  if (const Result<void> made = make_folder(folder); !made) return tl::unexpected(made.error());
  std::vector<std::string> written;
  ordered_json description = ordered_json::object();
  for (const MapFile& file : map_files(maps)) {
    const std::string name = fmt::format("{}.{}", file.name, options.depth == 32 ? "exr" : "png");
    const Result<std::string> bytes = encoded(file, options.depth);
    if (!bytes) return tl::unexpected(bytes.error());
    if (const auto done = write_file(folder / name, *bytes); !done) return tl::unexpected(done.error());
    description[file.name] = described(file, name, options.depth);
    written.push_back((folder / name).string());
  }
  BakedMaps plain;
  plain.mesh = maps.mesh;
  plain.tangents = maps.tangents;
  const Result<Mesh> mesh = mesh_with_maps(plain);
  if (!mesh) return tl::unexpected(mesh.error());
  const auto done = write_mesh(*mesh, folder / "mesh.glb").and_then([&] {
    return write_file(folder / "maps.json", description.dump(2) + "\n");
  });
  if (!done) return tl::unexpected(done.error());
  written.push_back((folder / "mesh.glb").string());
  written.push_back((folder / "maps.json").string());
  return written;
}

}  // namespace

bool is_model(const std::string& path) {
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  return extension == ".glb" || extension == ".gltf" || extension == ".obj";
}

Result<std::vector<std::string>> write_maps(Session& session, const BakedMaps& maps, const BakeFileOptions& options) {
  if (const Result<void> going = session.check_stop(); !going) return tl::unexpected(going.error());
  const Unstoppable writing;
  return is_model(options.path) ? write_model(maps, options) : write_folder(maps, options);
}

}  // namespace limn::cli
