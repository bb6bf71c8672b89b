#include "limn/asset/asset_layout.h"

#include <fmt/format.h>

#include "limn/base/hash.h"

namespace limn::asset {

std::optional<std::size_t> find_checksum(std::string_view file) {
  // Quotes within strings are escaped, so that no name or text in the file can pass for this.
  const std::string before = fmt::format("\"{}\":{{\"version\":{},\"checksum\":\"", kExtension, kVersion);
  const std::size_t at = file.find(before);
  if (at == std::string_view::npos || file.size() - at < before.size() + kNoChecksum.size()) return std::nullopt;
  return at + before.size();
}

std::string checksum_of(std::string_view file, std::size_t at) {
  Hash hash;
  const auto add = [&hash](std::string_view text) { hash.add(std::as_bytes(std::span(text.data(), text.size()))); };
  add(file.substr(0, at));
  add(file.substr(at + kNoChecksum.size()));
  return fmt::format("{:016x}", hash.value());
}

}  // namespace limn::asset
