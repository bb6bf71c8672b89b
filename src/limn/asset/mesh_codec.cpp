#include "limn/asset/mesh_codec.h"

#include <algorithm>

#include "limn/asset/connectivity_codec.h"
#include "limn/asset/position_codec.h"

namespace limn::asset {
namespace {

/// Digits and -1 as what a SymbolModel takes.
constexpr int kDigitBits = 4;

}  // namespace

std::vector<std::byte> encode_mesh(const Mesh& mesh) {
  RangeEncoder coder;
  ConnectivityCodec<RangeEncoder> connectivity(coder, mesh.positions.size());
  std::vector<Triangle> faces = mesh.faces;
  connectivity.code(faces, faces.size());
  const WholeNumbers numbers(WholeNumbers::digits_of(mesh.positions));
  coder.raw(static_cast<std::uint64_t>(numbers.digits()) + 1, kDigitBits);
  std::vector<Vec3> positions = mesh.positions;
  PositionCodec<RangeEncoder>(coder, numbers).code(positions, connectivity.guesses());
  std::vector<std::byte> bytes = coder.finish();
  pad(bytes, std::max(mesh.positions.size(), mesh.faces.size()));
  return bytes;
}

std::optional<Mesh> decode_mesh(std::span<const std::byte> bytes, std::size_t vertices, std::size_t faces) {
  const std::size_t most = std::min<std::size_t>(most_elements(bytes.size()), kInvalidId / 3);
  if (vertices > most || faces > most) return std::nullopt;
  RangeDecoder coder(bytes);
  ConnectivityCodec<RangeDecoder> connectivity(coder, vertices);
  Mesh mesh;
  if (!connectivity.code(mesh.faces, faces)) return std::nullopt;
  const int digits = static_cast<int>(coder.raw(0, kDigitBits)) - 1;
  if (digits > WholeNumbers::kMostDigits) return std::nullopt;
  const WholeNumbers numbers(digits);
  if (!PositionCodec<RangeDecoder>(coder, numbers).code(mesh.positions, connectivity.guesses())) return std::nullopt;
  if (coder.failed()) return std::nullopt;
  return mesh;
}

}  // namespace limn::asset
