#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return limn::fuzz::read(data, size, limn::MeshFormat::kGltf);
}
