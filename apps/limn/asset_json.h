#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "limn/asset/asset_file.h"

namespace limn::cli {

/// What a clip asset is made of, as `info` and `clip` print it.
nlohmann::ordered_json asset_json(const AssetBytes& bytes);
/// The same for people, a line a silhouette and one for the rest, as `info` lays out its lines.
std::string asset_text(const AssetBytes& bytes);

}  // namespace limn::cli
