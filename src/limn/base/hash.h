#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace limn {

/// A 64-bit hash, eight bytes at a time: against damage and mix-ups in files, not against malice. Little-endian
/// machines agree on it.
class Hash {
 public:
  void add(std::span<const std::byte> bytes) {
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + at, 8);
      mix(word);
    }
    std::uint64_t rest = bytes.size() - at;
    for (; at < bytes.size(); ++at)
      rest = rest << 8 | std::to_integer<std::uint64_t>(bytes[at]);
    mix(rest);
  }
  std::uint64_t value() const { return state_ ^ state_ >> 32; }

 private:
  void mix(std::uint64_t word) {
    state_ = std::rotl(state_ ^ word, 29) * 0x9e3779b97f4a7c15ull;
    state_ ^= state_ >> 31;
  }
  std::uint64_t state_ = 0x6c696d6e74726565ull;
};

inline std::uint64_t hash_of(std::span<const std::byte> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

}  // namespace limn
