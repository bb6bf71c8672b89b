#include <cstdlib>
#include <cstring>
#include <vector>

#include "limn/base/hash.h"
#include "limn/hull/sequence_file.h"

/// Reads the bytes as a hull sequence whose hash is right, since anybody can compute it, and stops the program when a
/// member has an index out of range.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHeader = 40, kHashAt = 32;
  std::vector<std::byte> bytes(size);
  if (size > 0) std::memcpy(bytes.data(), data, size);
  if (size >= kHeader) {
    std::memset(bytes.data() + kHashAt, 0, 8);
    limn::Hash hash;
    hash.add(std::span(bytes).first(kHeader));
    hash.add(std::span(bytes).subspan(kHeader));
    const std::uint64_t value = hash.value();
    std::memcpy(bytes.data() + kHashAt, &value, 8);
  }
  const limn::Result<limn::HullSequence> sequence = limn::parse_hull_sequence(bytes, "fuzz");
  if (!sequence) return 0;
  for (const int level : {sequence->innermost(), 0, sequence->outermost()}) {
    const limn::Mesh mesh = sequence->mesh_at(level);
    for (const limn::Triangle& face : mesh.faces) {
      for (const limn::VertexId vertex : face) {
        if (vertex >= mesh.positions.size()) std::abort();
      }
    }
  }
  return 0;
}
