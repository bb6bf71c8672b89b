#include "fuzz_reader.h"

/// Any format, told by content.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return limn::fuzz::read(data, size, limn::MeshFormat::kUnknown);
}
