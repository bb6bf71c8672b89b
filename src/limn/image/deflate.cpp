#include "limn/image/deflate.h"

#include <cstdlib>
#include <memory>

// stb's header declares it with its implementation only; the library exports it.
extern "C" unsigned char* stbi_zlib_compress(unsigned char* data, int data_len, int* out_len, int quality);

namespace limn {

std::optional<std::string> deflate(std::string_view bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  constexpr int kQuality = 8;
  if (bytes.size() >= kMost) return std::nullopt;
  // It takes a pointer to what it does not change.
  std::string copy(bytes);
  int size = 0;
  struct Free {
    void operator()(unsigned char* memory) const { std::free(memory); }
  };
  const std::unique_ptr<unsigned char, Free> packed(stbi_zlib_compress(reinterpret_cast<unsigned char*>(copy.data()),
                                                                       static_cast<int>(copy.size()), &size, kQuality));
  if (!packed) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(packed.get()), static_cast<std::size_t>(size));
}

}  // namespace limn
