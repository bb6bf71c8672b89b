#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "limn/mesh/formats/picture_bytes.h"
#include "limn/mesh/mesh.h"

namespace limn::formats {

/// The materials of an OBJ file, gathered from its MTL libraries.
///
/// The shape of an OBJ does not depend on its MTL, so nothing here is an error: a library or picture that is missing,
/// not understood, or lies outside the folder (read_reference() then reads nothing) becomes a note.
class ObjMaterials {
 public:
  /// \param folder  where references resolve; empty: none is read
  ObjMaterials(std::filesystem::path folder, std::vector<std::string>& notes)
      : folder_(std::move(folder)), notes_(notes) {}

  /// Reads what a mtllib statement names: one file (its name may hold blanks) or several. A library is read once,
  /// however often and in whatever spelling it is named.
  void read_libraries(std::string_view statement);

  /// The index of a material, made with default values when no library has it.
  std::uint32_t find_or_add(const std::string& name);

  std::vector<Material> take() { return std::move(materials_); }

 private:
  std::string file_key(const std::string& name) const;
  bool read_library(const std::string& name, bool last_attempt);
  void parse(std::string_view text);
  void set(Material& material, std::string_view key, std::string_view values);
  /// Into `image` and `mime`, which are `material`'s.
  void load_picture(const Material& material, std::string_view statement, std::vector<std::byte>& image,
                    std::string& mime);

  std::filesystem::path folder_;
  std::vector<std::string>& notes_;
  std::vector<Material> materials_;
  std::map<std::string, std::uint32_t, std::less<>> index_;
  std::map<std::string, bool, std::less<>> libraries_;                   ///< by file_key(): whether it could be read
  std::map<std::string, std::vector<std::byte>, std::less<>> pictures_;  ///< by file_key(); empty: not to be had
  PictureBudget budget_;
};

}  // namespace limn::formats
