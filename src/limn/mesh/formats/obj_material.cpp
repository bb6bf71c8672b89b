#include "limn/mesh/formats/obj_material.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/parse_number.h"
#include "limn/mesh/formats/reference.h"

namespace limn::formats {
namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Takes the first word off `text`.
std::string_view take_word(std::string_view& text) {
  text = trim(text);
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  text = trim(text);
  return word;
}

/// Up to `count` finite numbers; how many there were.
std::size_t take_numbers(std::string_view text, float* values, std::size_t count) {
  std::size_t taken = 0;
  while (taken < count) {
    const std::string_view word = take_word(text);
    float value = 0.0f;
    if (word.empty() || parse_float(word, value) != word.size() || !std::isfinite(value)) break;
    values[taken++] = value;
  }
  return taken;
}

/// How many values follow an option of a map statement; 0 for what is no option.
std::size_t option_values(std::string_view option) {
  if (option == "-mm") return 2;
  if (option == "-o" || option == "-s" || option == "-t") return 3;
  constexpr std::string_view kSingle[] = {"-blendu", "-blendv",  "-bm",     "-boost",      "-cc",
                                          "-clamp",  "-imfchan", "-texres", "-colorspace", "-type"};
  return std::find(std::begin(kSingle), std::end(kSingle), option) != std::end(kSingle) ? 1 : 0;
}

/// The file name of a map statement, its options left out. -o, -s and -t may have fewer than three numbers.
std::string_view map_file_name(std::string_view statement) {
  while (statement.starts_with('-')) {
    std::string_view rest = statement;
    std::size_t values = option_values(take_word(rest));
    if (values == 0) break;
    const bool optional = values == 3;
    for (std::size_t i = 0; i < values; ++i) {
      std::string_view after = rest;
      const std::string_view word = take_word(after);
      float number = 0.0f;
      if (optional && i > 0 && parse_float(word, number) != word.size()) break;
      rest = after;
    }
    statement = rest;
  }
  return trim(statement);
}

}  // namespace

void ObjMaterials::read_libraries(std::string_view statement) {
  statement = trim(statement);
  if (folder_.empty()) {
    notes_.push_back("material library \"" + std::string(statement) +
                     "\" not read: the model was not read from a file, so no other file belongs to it");
    return;
  }
  const bool several = statement.find_first_of(kBlanks) != std::string_view::npos;
  if (read_library(std::string(statement), !several) || !several) return;
  while (!statement.empty())
    read_library(std::string(take_word(statement)), true);
}

/// One string a file, however its name is spelled; one a spelling for names that read_reference() refuses by their
/// looks or finds no file for. Chooses between a coded and a literal name as it does.
std::string ObjMaterials::file_key(const std::string& name) const {
  const Result<std::filesystem::path> path = find_reference(folder_, name);
  return path ? path->string() : "?" + name;  // no canonical path begins so
}

bool ObjMaterials::read_library(const std::string& name, bool last_attempt) {
  const auto [entry, added] = libraries_.try_emplace(file_key(name), false);
  if (!added) return entry->second;
  const Result<std::vector<std::byte>> bytes = read_reference(folder_, name);
  if (!bytes) {
    if (last_attempt) notes_.push_back("material library \"" + name + "\" not read: " + bytes.error().message);
    return false;
  }
  entry->second = true;
  parse({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  return true;
}

std::uint32_t ObjMaterials::find_or_add(const std::string& name) {
  const auto [entry, added] = index_.try_emplace(name, static_cast<std::uint32_t>(materials_.size()));
  if (added) materials_.emplace_back().name = name;
  return entry->second;
}

void ObjMaterials::parse(std::string_view text) {
  std::uint32_t current = kInvalidId;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    const std::string_view key = take_word(line);
    if (key == "newmtl") {
      current = find_or_add(std::string(line));
    } else if (current != kInvalidId) {
      set(materials_[current], key, line);
    }
  }
}

void ObjMaterials::set(Material& material, std::string_view key, std::string_view values) {
  float v[3] = {};
  if (key == "Kd") {
    const std::size_t count = take_numbers(values, v, 3);
    if (count == 1) v[1] = v[2] = v[0];
    if (count == 1 || count == 3) material.base_color = Vec4(v[0], v[1], v[2], material.base_color.a);
  } else if (key == "d" && take_numbers(values, v, 1) == 1) {
    material.base_color.a = std::clamp(v[0], 0.0f, 1.0f);
  } else if (key == "Tr" && take_numbers(values, v, 1) == 1) {
    material.base_color.a = 1.0f - std::clamp(v[0], 0.0f, 1.0f);
  } else if (key == "Pr" && take_numbers(values, v, 1) == 1) {
    material.roughness = std::clamp(v[0], 0.0f, 1.0f);
  } else if (key == "Pm" && take_numbers(values, v, 1) == 1) {
    material.metallic = std::clamp(v[0], 0.0f, 1.0f);
  } else if (key == "map_Kd") {
    load_picture(material, values, material.base_color_image, material.base_color_image_mime);
  } else if (key == "norm") {
    load_picture(material, values, material.normal_image, material.normal_image_mime);
  }
}

void ObjMaterials::load_picture(const Material& material, std::string_view statement, std::vector<std::byte>& image,
                                std::string& mime) {
  const std::string name(map_file_name(statement));
  std::string file = file_key(name);
  auto entry = pictures_.find(file);
  if (entry == pictures_.end()) {
    Result<std::vector<std::byte>> bytes = read_reference(folder_, name);
    if (!bytes) {
      notes_.push_back("picture \"" + name + "\" of material \"" + material.name +
                       "\" not read: " + bytes.error().message);
      bytes = std::vector<std::byte>();
    } else if (picture_mime(*bytes).empty()) {
      notes_.push_back("picture \"" + name + "\" of material \"" + material.name + "\" left out: neither PNG nor JPEG");
      bytes->clear();
    }
    entry = pictures_.emplace(std::move(file), std::move(*bytes)).first;
  } else if (!budget_.take_copy(entry->second.size())) {
    notes_.push_back("picture \"" + name + "\" of material \"" + material.name + "\" left out: used too many times");
    return;
  }
  image = entry->second;
  mime = picture_mime(entry->second);
}

}  // namespace limn::formats
