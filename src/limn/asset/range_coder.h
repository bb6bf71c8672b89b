#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn::asset {

/// How likely a bit is 0, learnt from those before it: the mean of a quick and a slow learner. 16 bits each.
class Probability {
 public:
  static constexpr int kBits = 12;

  std::uint32_t of_zero() const {
    constexpr std::uint32_t kLeast = 4, kMost = (1u << kBits) - kLeast;
    const std::uint32_t p = (std::uint32_t{quick_} + slow_) >> 5;
    return p < kLeast ? kLeast : p > kMost ? kMost : p;
  }
  void learn(bool bit) {
    quick_ = towards(quick_, bit, 4);
    slow_ = towards(slow_, bit, 7);
  }

 private:
  static std::uint16_t towards(std::uint16_t p, bool bit, int shift) {
    return static_cast<std::uint16_t>(bit ? p - (p >> shift) : p + ((65535 - p) >> shift));
  }
  std::uint16_t quick_ = 1 << 15;
  std::uint16_t slow_ = 1 << 15;
};

/// Writes bits in as few bytes as their probabilities allow (a range coder, Martin 1979).
///
/// Encoder and decoder have the same functions, so that a format is described once, by a template that gets either:
/// each takes a value, which the encoder writes and returns, and which the decoder ignores and returns as it was
/// written.
class RangeEncoder {
 public:
  static constexpr bool kDecodes = false;

  bool bit(Probability& probability, bool value) {
    const std::uint32_t bound = (range_ >> Probability::kBits) * probability.of_zero();
    if (value) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    probability.learn(value);
    normalize();
    return value;
  }

  /// The lowest `bits` bits of a value, each as likely 0 as 1. \pre bits <= 64, value < 2^bits
  std::uint64_t raw(std::uint64_t value, int bits) {
    while (bits > 0) {
      const int now = bits < 16 ? bits : 16;
      bits -= now;
      range_ >>= now;
      low_ += std::uint64_t{range_} * (value >> bits & ((1u << now) - 1));
      normalize();
    }
    return value;
  }

  bool failed() const { return false; }

  /// The bytes; the encoder is done then.
  std::vector<std::byte> finish() {
    for (int i = 0; i < 5; ++i)
      shift_low();
    return std::move(bytes_);
  }

 private:
  void normalize() {
    while (range_ < 1u << 24) {
      range_ <<= 8;
      shift_low();
    }
  }
  /// A carry may still run through bytes of 255: they are held back until it is known.
  void shift_low() {
    if (low_ < 0xff000000u || low_ > 0xffffffffu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      for (; held_ > 0; --held_) {
        bytes_.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(byte_ + carry)));
        byte_ = 0xff;
      }
      byte_ = static_cast<std::uint8_t>(low_ >> 24);
    }
    ++held_;
    low_ = (low_ & 0x00ffffffu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint64_t held_ = 1;
  std::uint8_t byte_ = 0;
  std::vector<std::byte> bytes_;
};

/// Reads what RangeEncoder wrote. Any bytes decode to something: what they say must be checked, and failed() asked
/// before each loop goes round, which bounds what a stream of any bytes can claim.
class RangeDecoder {
 public:
  static constexpr bool kDecodes = true;

  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (int i = 0; i < 5; ++i)
      code_ = code_ << 8 | next();
  }

  bool bit(Probability& probability, bool = false) {
    const std::uint32_t bound = (range_ >> Probability::kBits) * probability.of_zero();
    const bool value = code_ >= bound;
    if (value) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    probability.learn(value);
    normalize();
    return value;
  }

  std::uint64_t raw(std::uint64_t, int bits) {
    std::uint64_t value = 0;
    while (bits > 0) {
      const int now = bits < 16 ? bits : 16;
      bits -= now;
      range_ >>= now;
      const std::uint32_t most = (1u << now) - 1;
      const std::uint32_t part = code_ / range_ < most ? code_ / range_ : most;
      code_ -= part * range_;
      value = value << now | part;
      normalize();
    }
    return value;
  }

  /// Whether more was read than there is: the stream is not what an encoder wrote.
  bool failed() const { return beyond_ > 0; }

 private:
  void normalize() {
    while (range_ < 1u << 24) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
  }
  std::uint32_t next() {
    if (at_ < bytes_.size()) return std::to_integer<std::uint32_t>(bytes_[at_++]);
    ++beyond_;
    return 0;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::size_t beyond_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint32_t code_ = 0;
};

/// A number below 2^Bits, each of which is learnt by itself.
template <int Bits>
class SymbolModel {
 public:
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    std::uint32_t node = 1;
    for (int i = Bits - 1; i >= 0; --i)
      node = node << 1 | static_cast<std::uint32_t>(coder.bit(nodes_[node], (value >> i & 1u) != 0));
    return node - (1u << Bits);
  }

 private:
  std::array<Probability, std::size_t{1} << Bits> nodes_;
};

/// A number whose size is learnt, and its leading bits with it; the rest are as they come. \pre value < 2^62
class NumberModel {
 public:
  template <class Coder>
  std::uint64_t code(Coder& coder, std::uint64_t value) {
    const std::uint32_t width = widths_.code(coder, static_cast<std::uint32_t>(std::bit_width(value)));
    if (width < 2) return width;
    if (width > 62) return ~std::uint64_t{0};  // never written
    const bool second = coder.bit(second_[width], (value >> (width - 2) & 1u) != 0);
    const int rest = static_cast<int>(width) - 2;
    const std::uint64_t low = coder.raw(value & ((std::uint64_t{1} << rest) - 1), rest);
    return ((std::uint64_t{2} | static_cast<std::uint64_t>(second)) << rest) | low;
  }

 private:
  SymbolModel<6> widths_;
  std::array<Probability, 64> second_;
};

/// No stream holds more elements than this, faces or vertices or texels: shorter ones are padded, so that a claim can
/// be judged by its bytes before anything is allocated.
constexpr std::size_t most_elements(std::size_t bytes) {
  return 8 * bytes;
}
inline void pad(std::vector<std::byte>& bytes, std::size_t elements) {
  if (most_elements(bytes.size()) < elements) bytes.resize((elements + 7) / 8);
}

/// Whole numbers of either sign as numbers from 0, the small ones first.
inline std::uint64_t zigzag(std::int64_t value) {
  return (static_cast<std::uint64_t>(value) << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0);
}
inline std::int64_t unzigzag(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1 ^ ((value & 1u) != 0 ? ~std::uint64_t{0} : 0));
}

}  // namespace limn::asset
