#include <fmt/format.h>
#include <string>

#include "limn/mesh/formats/formats.h"

#ifdef LIMN_WITH_ASSIMP
#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cstring>
#include <exception>
#endif

namespace limn::formats {
#ifdef LIMN_WITH_ASSIMP
namespace {

/// The model's bytes as the only file there is.
class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : bytes_(bytes) {}

  size_t Read(void* buffer, size_t size, size_t count) override {
    if (size == 0) return 0;
    const std::size_t elements = std::min(count, (bytes_.size() - at_) / size);
    if (elements != 0) std::memcpy(buffer, bytes_.data() + at_, elements * size);
    at_ += elements * size;
    return elements;
  }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    // Offsets back from the end or from here arrive as huge numbers; the sum wraps to what was meant.
    const std::size_t to = base + offset;
    if (to > bytes_.size()) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  size_t Tell() const override { return at_; }
  size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

/// A file system with one file in it: nothing else can be opened, found or written, wherever the model points.
class OneFile : public Assimp::IOSystem {
 public:
  OneFile(std::span<const std::byte> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  bool Exists(const char* file) const override { return name_ == file; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (name_ == file && std::strchr(mode, 'w') == nullptr) return new MemoryStream(bytes_);
    if (refused_.empty()) refused_ = file;
    return nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

  const std::string& refused() const { return refused_; }

 private:
  std::span<const std::byte> bytes_;
  std::string name_;
  std::string refused_;
};

template <class T>
void append(CornerAttribute<T>& attribute, std::size_t first, const aiMesh& mesh, bool present, const T& otherwise,
            auto&& get) {
  if (!present && attribute.empty()) return;
  attribute.values.resize(first, otherwise);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i)
    attribute.values.push_back(present ? get(i) : otherwise);
}

Vec3 to_vec3(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

void append_mesh(Mesh& out, const aiMesh& mesh, std::size_t& left_out) {
  const std::size_t first = out.positions.size();
  for (unsigned i = 0; i < mesh.mNumVertices; ++i)
    out.positions.push_back(to_vec3(mesh.mVertices[i]));
  append(out.normals, first, mesh, mesh.HasNormals(), Vec3(0.0f),
         [&](unsigned i) { return to_vec3(mesh.mNormals[i]); });
  append(out.uvs, first, mesh, mesh.HasTextureCoords(0), Vec2(0.0f),
         [&](unsigned i) { return Vec2(mesh.mTextureCoords[0][i].x, mesh.mTextureCoords[0][i].y); });
  append(out.colors, first, mesh, mesh.HasVertexColors(0), Vec4(1.0f), [&](unsigned i) {
    const aiColor4D& c = mesh.mColors[0][i];
    return Vec4(c.r, c.g, c.b, c.a);
  });
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) {
      ++left_out;
      continue;
    }
    Triangle triangle{};
    for (std::size_t c = 0; c < 3; ++c)
      triangle[c] = static_cast<VertexId>(first + face.mIndices[c]);
    out.faces.push_back(triangle);
    out.face_materials.push_back(mesh.mMaterialIndex);
  }
}

Material to_material(const aiMaterial& from) {
  Material material;
  aiString name;
  if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = name.C_Str();
  aiColor4D color;
  if (from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS)
    material.base_color = {color.r, color.g, color.b, 1.0f};
  float opacity = 1.0f;
  if (from.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS) material.base_color.a = std::clamp(opacity, 0.0f, 1.0f);
  int two_sided = 0;
  if (from.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS) material.double_sided = two_sided != 0;
  return material;
}

Mesh to_mesh(const aiScene& scene, std::vector<std::string>& notes) {
  Mesh mesh;
  std::size_t left_out = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i)
    append_mesh(mesh, *scene.mMeshes[i], left_out);
  const std::size_t count = mesh.positions.size();
  if (!mesh.normals.empty()) mesh.normals.values.resize(count, Vec3(0.0f));
  if (!mesh.uvs.empty()) mesh.uvs.values.resize(count, Vec2(0.0f));
  if (!mesh.colors.empty()) mesh.colors.values.resize(count, Vec4(1.0f));
  bool pictures = false;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    mesh.materials.push_back(to_material(*scene.mMaterials[i]));
    pictures |= scene.mMaterials[i]->GetTextureCount(aiTextureType_DIFFUSE) > 0 ||
                scene.mMaterials[i]->GetTextureCount(aiTextureType_NORMALS) > 0;
  }
  const bool one_material =
      std::all_of(mesh.face_materials.begin(), mesh.face_materials.end(), [](std::uint32_t m) { return m == 0; });
  if (one_material) mesh.face_materials.clear();
  if (left_out != 0) notes.push_back(fmt::format("{} points and lines left out", left_out));
  if (pictures) notes.emplace_back("textures left out");
  if (scene.HasAnimations()) notes.push_back(fmt::format("{} animations left out", scene.mNumAnimations));
  return mesh;
}

std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  const auto plain = [](unsigned char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.'; };
  for (char& c : extension)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::all_of(extension.begin(), extension.end(), plain) ? extension : std::string();
}

Result<ImportedMesh> import(const Source& source) {
  Assimp::Importer importer;
  auto* const files = new OneFile(source.bytes, "model" + extension_of(source.name));
  importer.SetIOHandler(files);  // takes it over
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, 0);
  const unsigned steps = aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_ValidateDataStructure;
  const aiScene* const scene = importer.ReadFile("model" + extension_of(source.name), steps);
  if (scene == nullptr) {
    const std::string reason =
        files->refused().empty() ? "" : fmt::format(" (it refers to \"{}\", which was not read)", files->refused());
    return fail_at(ErrorCode::kUnreadable, source.name, {},
                   fmt::format("assimp: {}{}", importer.GetErrorString(), reason),
                   "convert the model to glTF, OBJ or PLY");
  }
  ImportedMesh result;
  result.format = MeshFormat::kOther;
  const aiImporterDesc* const importer_used =
      importer.GetImporterInfo(static_cast<std::size_t>(std::max(importer.GetPropertyInteger("importerIndex", -1), 0)));
  result.notes.push_back(
      fmt::format("read through assimp as {}", importer_used != nullptr ? importer_used->mName : "another format"));
  if (!files->refused().empty())
    result.notes.push_back(fmt::format("\"{}\" and other files beside it not read", files->refused()));
  result.mesh = to_mesh(*scene, result.notes);
  return result;
}

}  // namespace

Result<ImportedMesh> read_other(const Source& source) try {
  if (!report(source.progress, "reading", 0.0)) return fail_at(ErrorCode::kCancelled, source.name, {}, "cancelled");
  if (source.bytes.empty()) return fail_at(ErrorCode::kUnreadable, source.name, {}, "the file is empty");
  return import(source);
} catch (const std::exception& error) {
  return fail_at(ErrorCode::kUnreadable, source.name, {}, fmt::format("assimp: {}", error.what()),
                 "convert the model to glTF, OBJ or PLY");
}
#else
Result<ImportedMesh> read_other(const Source& source) {
  return fail_at(ErrorCode::kUnreadable, source.name, {}, "this format needs assimp, which limn was built without",
                 "install assimp and build again, or convert the model to glTF, OBJ or PLY");
}
#endif

}  // namespace limn::formats
