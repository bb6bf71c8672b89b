#include <chrono>
#include <filesystem>
#include <gtest/gtest.h>

#include "limn/base/file.h"
#include "limn/mesh/import.h"

namespace limn {
namespace {

namespace fs = std::filesystem;

/// Reads a kept file in its own format and as every other, as a mistaken caller would.
void read_as_everything(const fs::path& path) {
  const Result<FileBytes> file = FileBytes::open(path);
  ASSERT_TRUE(file);
  using enum MeshFormat;
  for (const MeshFormat format : {kUnknown, kPly, kStl, kOff, kObj, kGltf, kGlb}) {
    const Result<ImportedMesh> imported = read_mesh(file->bytes(), format, path.filename().string());
    if (!imported) {
      EXPECT_FALSE(imported.error().message.empty()) << path;
      EXPECT_FALSE(imported.error().file.empty()) << path;
      continue;
    }
    const Mesh& mesh = imported->mesh;
    for (const Triangle& face : mesh.faces) {
      for (const VertexId vertex : face)
        ASSERT_LT(vertex, mesh.positions.size()) << path;
    }
    for (const Vec3& position : mesh.positions)
      ASSERT_TRUE(is_finite(position)) << path;
  }
}

TEST(FuzzCorpus, EveryKeptFileIsReadOrRefusedInTime) {
  std::size_t files = 0;
  for (const char* const format : {"ply", "stl", "off", "obj", "gltf"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(LIMN_SOURCE_DIR) / "fuzz/corpus" / format)) {
      const auto start = std::chrono::steady_clock::now();
      read_as_everything(entry.path());
      EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << entry.path();
      ++files;
    }
  }
  EXPECT_GE(files, 40u);
}

}  // namespace
}  // namespace limn
