#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "limn/base/result.h"

/// The files that a model refers to. Only those in its folder or below are ever read.
namespace limn::formats {

/// Why a reference must not be followed, told by its looks alone, %xx decoded: absolute paths, "..", schemes and
/// drives, backslashes, control characters. Empty when it may be; find_reference() then judges links.
std::string_view objection_to_reference(std::string_view reference);

/// Whether anything lies where a reference leads, as written or %xx decoded. A link counts, wherever it leads.
/// \pre objection_to_reference(reference) is empty
bool reference_exists(const std::filesystem::path& folder, std::string_view reference);

/// The file that a reference leads to, relative to `folder`: its canonical path, the same for every spelling.
/// Errors: kUnreadable, naming the reference, for what objection_to_reference() objects to, links that lead out of the
/// folder, and what is no file.
Result<std::filesystem::path> find_reference(const std::filesystem::path& folder, std::string_view reference);

/// Reads the file that find_reference() finds. Errors: as there; kUnreadable when it cannot be read.
Result<std::vector<std::byte>> read_reference(const std::filesystem::path& folder, std::string_view reference);

}  // namespace limn::formats
