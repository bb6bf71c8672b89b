#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/gltf_json.h"

namespace limn::formats::gltf {

/// The bytes of a buffer view, inside their buffer, and how far apart its elements are (0: side by side).
struct View {
  std::span<const std::byte> bytes;
  std::size_t stride = 0;
};

/// An encoded picture. `bytes` stay where they are while the document lives.
struct Picture {
  std::span<const std::byte> bytes;  ///< empty when the picture is not to be had; a note then says why
  std::string mime;
};

/// A glTF file taken apart: the container, the JSON, and every buffer it names.
///
/// Construction reads all buffers and checks every reference of the file, used or not, so that a file which points
/// outside its folder is refused as a whole and before anything is read there.
class Document {
 public:
  /// Throws Failure. \param source, notes  must outlive the document
  Document(const Source& source, std::vector<std::string>& notes);

  Field root() const { return {&json_, {}}; }
  Field operator[](std::string_view key) const { return root()[key]; }
  bool binary() const { return binary_; }
  const Progress& progress() const { return source_.progress; }
  /// The size of the file and of the files it refers to that were read so far, each counted once.
  std::uint64_t bytes_read() const { return bytes_; }

  /// The bytes of bufferViews[index], decompressed where needed. Throws Failure when they are not all there, or when
  /// all that was decompressed comes to more than 64 times bytes_read() and 16 MiB.
  View view(std::size_t index);
  /// The encoded picture images[index]; read once, however often it is asked for.
  Picture picture(std::size_t index);

  /// Counts vertices or faces about to be stored; throws Failure when the file claims more than its size makes
  /// plausible.
  void claim(std::uint64_t elements, const std::string& where);
  /// Adds a note unless the same one was given before, or there are a thousand.
  void note(const std::string& text);

 private:
  void open_container();
  void parse(std::string_view text);
  void check_asset() const;
  void check_extensions();
  void load_buffers();
  void check_picture_references();
  std::span<const std::byte> load(const Field& uri);
  std::span<const std::byte> buffer_range(const Field& owner) const;
  View decompress(std::size_t index, const Field& extension);
  void take_decompressed(std::uint64_t size, const std::string& where);
  Picture read_picture(const Field& image);

  const Source& source_;
  std::vector<std::string>& notes_;
  bool binary_ = false;
  Json json_;
  std::span<const std::byte> chunk_;
  std::map<std::filesystem::path, std::vector<std::byte>> files_;  ///< by canonical path
  std::map<std::string, std::vector<std::byte>> embedded_;         ///< data URIs, by place
  std::vector<std::span<const std::byte>> buffers_;
  std::map<std::size_t, std::vector<std::byte>> decompressed_;
  std::map<std::size_t, Picture> pictures_;
  std::uint64_t bytes_ = 0;
  std::uint64_t decompressed_bytes_ = 0;
  std::uint64_t claimed_ = 0;
};

}  // namespace limn::formats::gltf
