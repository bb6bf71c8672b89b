#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "limn/base/result.h"

namespace limn {

/// A whole file in memory, read-only: mapped where the system can, read otherwise. "-" reads standard input to its end.
/// Moves, does not copy; the bytes stay where they are until it is destroyed.
class FileBytes {
 public:
  /// Errors: kUnreadable when the path does not exist, is a directory, or may not be read.
  static Result<FileBytes> open(const std::filesystem::path& path);

  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;
  ~FileBytes();

  std::span<const std::byte> bytes() const { return bytes_; }
  std::string_view text() const { return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()}; }

 private:
  FileBytes() = default;
  void release();
  std::span<const std::byte> bytes_;
  std::vector<std::byte> storage_;
  bool mapped_ = false;
};

/// Writes a file whole or not at all: beside its destination first, then renamed over it. "-" writes standard output.
/// Keeps the permissions of a file it replaces. Errors: kUnwritable; the destination is then as it was before.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace limn
