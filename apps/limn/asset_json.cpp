#include "asset_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mesh_files.h"

namespace limn::cli {

using nlohmann::ordered_json;

ordered_json asset_json(const AssetBytes& bytes) {
  ordered_json levels = ordered_json::array();
  for (const AssetBytes::Level& level : bytes.levels) {
    levels.push_back(
        {{"faces", level.faces}, {"error", level.error}, {"mesh_bytes", level.mesh}, {"search_bytes", level.search}});
  }
  return {{"levels", std::move(levels)},
          {"file_bytes", bytes.file},
          {"normals_bytes", bytes.normals},
          {"colors_bytes", bytes.colors},
          {"displacement_bytes", bytes.displacement},
          {"mesh_bytes", bytes.rest()}};
}

std::string asset_text(const AssetBytes& bytes) {
  std::string text;
  for (const AssetBytes::Level& level : bytes.levels) {
    const double each = static_cast<double>(level.mesh + level.search) / static_cast<double>(level.faces);
    text += fmt::format("{:<13}{}, {}, {} ({:.2f} a triangle)\n", "silhouette", counted(level.faces, "triangle"),
                        level.error > 0 ? fmt::format("within {:.4g}", level.error) : std::string("exact"),
                        counted(level.mesh + level.search, "byte"), each);
  }
  text +=
      fmt::format("{:<13}{}: maps {}, mesh with its own pictures {}\n", "clip asset", counted(bytes.file, "byte"),
                  counted(bytes.normals + bytes.colors + bytes.displacement, "byte"), counted(bytes.rest(), "byte"));
  return text;
}

}  // namespace limn::cli
