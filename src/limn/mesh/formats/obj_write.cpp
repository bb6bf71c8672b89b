#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <string>
#include <string_view>

#include "limn/mesh/formats/formats.h"

namespace limn::formats {
namespace {

/// The shortest digits that read back as the same float.
void append(std::string& text, float value) {
  char digits[24];
  const std::to_chars_result end = std::to_chars(std::begin(digits), std::end(digits), value);
  text.append(digits, end.ptr);
}

void append(std::string& text, std::uint64_t value) {
  char digits[24];
  const std::to_chars_result end = std::to_chars(std::begin(digits), std::end(digits), value);
  text.append(digits, end.ptr);
}

template <class... Values>
void append_line(std::string& text, std::string_view key, Values... values) {
  text += key;
  ((text += ' ', append(text, values)), ...);
  text += '\n';
}

/// A material's name as one line can hold it, unlike every earlier one.
std::string unique_name(const Material& material, std::size_t number, std::set<std::string>& taken) {
  std::string name = material.name;
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == '\\') c = '_';
  }
  const auto is_blank = [](char c) { return c == ' '; };
  name.erase(name.begin(), std::find_if_not(name.begin(), name.end(), is_blank));
  name.erase(std::find_if_not(name.rbegin(), name.rend(), is_blank).base(), name.end());
  if (name.empty()) name = fmt::format("material_{}", number + 1);
  while (!taken.insert(name).second)
    name += fmt::format("_{}", number + 1);
  return name;
}

/// Letters, digits, '-' and '_' only, so that the name is good on every system.
std::string file_name_part(const std::string& name) {
  std::string part;
  for (const char c : name) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    part += plain ? c : '_';
  }
  return part;
}

/// The start of the names of the files beside the model: its own name, as a statement can hold it and read_reference()
/// follows it.
std::string companion_stem(const std::filesystem::path& path) {
  std::string stem = path.stem().string();
  for (char& c : stem) {
    if (static_cast<unsigned char>(c) < 0x20 || c == ':' || c == '\\' || c == '%') c = '_';
  }
  // Blanks in front would be left out; a dash there begins an option.
  for (std::size_t i = 0; i < stem.size() && (stem[i] == ' ' || stem[i] == '-'); ++i)
    stem[i] = '_';
  return stem;
}

/// The MTL text; pictures are added to `files`.
std::string material_library(const Mesh& mesh, const std::vector<std::string>& names, const std::filesystem::path& path,
                             std::vector<OutputFile>& files) {
  const std::string file_stem = companion_stem(path);
  std::string text = "# materials of " + file_stem + ".obj\n";
  std::set<std::string> picture_names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Material& material = mesh.materials[i];
    text += "newmtl " + names[i] + "\n";
    append_line(text, "Kd", material.base_color.r, material.base_color.g, material.base_color.b);
    append_line(text, "d", material.base_color.a);
    append_line(text, "Pr", material.roughness);
    append_line(text, "Pm", material.metallic);
    if (material.base_color_image.empty() && material.normal_image.empty()) continue;
    std::string stem = file_stem + "-" + file_name_part(names[i]);
    while (!picture_names.insert(stem).second)
      stem += fmt::format("_{}", i + 1);
    const auto add_picture = [&](const char* key, const std::vector<std::byte>& image, const std::string& mime,
                                 const char* end) {
      if (image.empty()) return;
      const std::string name = stem + end + (mime == "image/jpeg" ? ".jpg" : ".png");
      text += fmt::format("{} {}\n", key, name);
      files.push_back(
          {path.parent_path() / name, std::string(reinterpret_cast<const char*>(image.data()), image.size())});
    };
    add_picture("map_Kd", material.base_color_image, material.base_color_image_mime, "");
    // A material's name never gives a point, so this cannot be another's picture.
    add_picture("norm", material.normal_image, material.normal_image_mime, ".normal");
  }
  return text;
}

/// Colours belong to vertices in OBJ: where a vertex's corners differ in colour it must be repeated.
struct ColoredVertices {
  std::vector<Vec3> positions;
  std::vector<Vec4> colors;
  std::vector<Triangle> faces;
};

ColoredVertices split_by_color(const Mesh& mesh) {
  Mesh part;
  part.positions = mesh.positions;
  part.faces = mesh.faces;
  part.colors = mesh.colors;
  VertexMesh split = one_value_per_vertex(part);
  return {std::move(split.positions), std::move(split.colors), std::move(split.faces)};
}

void write_vertices(std::string& text, const std::vector<Vec3>& positions, const std::vector<Vec4>& colors) {
  const bool opaque = std::all_of(colors.begin(), colors.end(), [](const Vec4& c) { return c.a == 1.0f; });
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& p = positions[i];
    if (colors.empty()) {
      append_line(text, "v", p.x, p.y, p.z);
    } else if (opaque) {
      append_line(text, "v", p.x, p.y, p.z, colors[i].r, colors[i].g, colors[i].b);
    } else {
      append_line(text, "v", p.x, p.y, p.z, colors[i].r, colors[i].g, colors[i].b, colors[i].a);
    }
  }
}

void write_faces(std::string& text, const Mesh& mesh, const std::vector<Triangle>& faces,
                 const std::vector<std::string>& names) {
  std::uint32_t current = kInvalidId;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::uint32_t material = mesh.face_materials.empty() ? 0 : mesh.face_materials[f];
    if (material != current && material < names.size()) {
      text += "usemtl " + names[material] + "\n";
      current = material;
    }
    text += 'f';
    for (int c = 0; c < 3; ++c) {
      text += ' ';
      append(text, std::uint64_t{faces[f][static_cast<std::size_t>(c)]} + 1);
      if (mesh.uvs.empty() && mesh.normals.empty()) continue;
      text += '/';
      const auto face = static_cast<FaceId>(f);
      if (!mesh.uvs.empty()) append(text, std::uint64_t{mesh.corner_index(mesh.uvs, face, c)} + 1);
      if (mesh.normals.empty()) continue;
      text += '/';
      append(text, std::uint64_t{mesh.corner_index(mesh.normals, face, c)} + 1);
    }
    text += '\n';
  }
}

}  // namespace

Result<std::vector<OutputFile>> write_obj(const Mesh& mesh, const std::filesystem::path& path) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!is_finite(mesh.positions[i])) {
      return fail_at(ErrorCode::kInvalidArgument, path.string(), "vertex " + std::to_string(i),
                     "a coordinate is not finite");
    }
  }
  std::vector<OutputFile> files(1);
  files[0].path = path;
  std::string& text = files[0].bytes;
  text.reserve(40 * (mesh.positions.size() + mesh.faces.size()));
  std::vector<std::string> names;
  // Standard output has no place for a second file.
  if (path != "-" && !mesh.faces.empty()) {
    std::set<std::string> taken;
    for (const Material& material : mesh.materials)
      names.push_back(unique_name(material, names.size(), taken));
  }
  if (!names.empty()) text += "mtllib " + companion_stem(path) + ".mtl\n";
  const bool split = !mesh.colors.indices.empty();
  const ColoredVertices colored = split ? split_by_color(mesh) : ColoredVertices{};
  write_vertices(text, split ? colored.positions : mesh.positions, split ? colored.colors : mesh.colors.values);
  for (const Vec2& uv : mesh.uvs.values)
    append_line(text, "vt", uv.x, uv.y);
  for (const Vec3& n : mesh.normals.values)
    append_line(text, "vn", n.x, n.y, n.z);
  write_faces(text, mesh, split ? colored.faces : mesh.faces, names);
  if (!names.empty()) {
    std::string library = material_library(mesh, names, path, files);
    files.push_back({path.parent_path() / (companion_stem(path) + ".mtl"), std::move(library)});
  }
  return files;
}

}  // namespace limn::formats
