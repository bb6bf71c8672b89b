#include "limn/mesh/formats/gltf_document.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#ifdef LIMN_WITH_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include "limn/mesh/formats/base64.h"
#include "limn/mesh/formats/picture_bytes.h"
#include "limn/mesh/formats/reference.h"

namespace limn::formats::gltf {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67u;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534au;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942u;   // "BIN\0"
constexpr std::string_view kMeshopt = "EXT_meshopt_compression";
constexpr std::string_view kDraco = "KHR_draco_mesh_compression";

/// Little-endian, whatever the machine.
std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t k = 4; k-- > 0;)
    word = word << 8 | std::to_integer<std::uint32_t>(bytes[at + k]);
  return word;
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Fit for a message: shortened, control characters replaced.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  std::string result;
  for (const char c : text.substr(0, kLongest))
    result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return text.size() > kLongest ? result + "…" : result;
}

/// Refuses a reference by its looks.
void check_reference(const Field& uri) {
  const std::string reference = uri.string();
  const std::string_view reason = objection_to_reference(reference);
  if (!reason.empty()) {
    refuse(uri.path(), fmt::format("\"{}\" {}; nothing was read there", shown(reference), reason),
           "put the file beside the model and name it without a path");
  }
}

bool is_data_uri(std::string_view uri) {
  return uri.starts_with("data:");
}

std::vector<std::byte> decode_data_uri(const Field& field) {
  const std::string uri = field.string();
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) {
    refuse(field.path(), "is a data URI without base64 data");
  }
  std::optional<std::vector<std::byte>> bytes = decode_base64(std::string_view(uri).substr(comma + 1));
  if (!bytes) refuse(field.path(), "holds malformed base64 data", "the file may be truncated");
  return *std::move(bytes);
}

bool understands(std::string_view extension) {
#ifdef LIMN_WITH_MESHOPTIMIZER
  if (extension == kMeshopt) return true;
#endif
#ifdef LIMN_WITH_DRACO
  if (extension == kDraco) return true;
#endif
  return extension == "KHR_mesh_quantization" || extension == "KHR_materials_unlit" ||
         extension == "KHR_texture_transform";
}

std::string_view extension_remedy(std::string_view extension) {
  if (extension == kDraco || extension == kMeshopt)
    return "build limn with its library, or decompress the model: gltf-transform copy IN OUT";
  return "export the model without this extension";
}

}  // namespace

Document::Document(const Source& source, std::vector<std::string>& notes) : source_(source), notes_(notes) {
  bytes_ = source.bytes.size();
  open_container();
  check_asset();
  check_extensions();
  load_buffers();
  check_picture_references();
}

void Document::note(const std::string& text) {
  constexpr std::size_t kMostNotes = 1000;
  if (notes_.size() >= kMostNotes) return;
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

void Document::claim(std::uint64_t elements, const std::string& where) {
  // Plain data takes more than a byte for each of these; the floor leaves room for compression and repeated meshes.
  const std::uint64_t most = std::min((std::uint64_t{1} << 22) + bytes_, std::uint64_t{kInvalidId} / 3);
  if (elements > most - claimed_) {
    refuse(
        where,
        fmt::format("brings the model to more than {} vertices and faces, too many for {} bytes of data", most, bytes_),
        "check the count; a model that repeats its meshes so often must be split");
  }
  claimed_ += elements;
}

void Document::open_container() {
  const std::span<const std::byte> bytes = source_.bytes;
  if (bytes.empty()) refuse({}, "the file is empty");
  binary_ = bytes.size() >= 4 && word_at(bytes, 0) == kGlbMagic;
  if (!binary_) {
    std::string_view text = as_text(bytes);
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    parse(text);
    return;
  }
  if (bytes.size() < 20) refuse("header", "the file ends within the GLB header", "the file is truncated");
  if (word_at(bytes, 4) != 2)
    refuse("header", fmt::format("GLB version {} is not supported; version 2 is", word_at(bytes, 4)));
  const std::size_t length = word_at(bytes, 8);
  if (length > bytes.size()) {
    refuse("header", fmt::format("claims {} bytes, the file has {}", length, bytes.size()), "the file is truncated");
  }
  if (length < bytes.size()) note(fmt::format("{} bytes after the end of the GLB left out", bytes.size() - length));
  std::string_view json;
  bool have_bin = false;
  for (std::size_t at = 12, number = 0; at < length; ++number) {
    const std::string where = fmt::format("chunk {}", number);
    if (length - at < 8) refuse(where, "the file ends within a chunk header");
    const std::size_t size = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
    at += 8;
    if (size > length - at)
      refuse(where, fmt::format("claims {} bytes, {} are left", size, length - at), "the file is truncated");
    if (number == 0 && type != kJsonChunk) refuse(where, "the first chunk must be JSON");
    if (number == 0) json = as_text(bytes.subspan(at, size));
    if (type == kBinChunk && !have_bin) {
      chunk_ = bytes.subspan(at, size);
      have_bin = true;
    }
    // The last chunk's padding may be missing.
    at += std::min((size + 3) / 4 * 4, length - at);
  }
  parse(json);
}

void Document::parse(std::string_view text) {
  try {
    json_ = Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::string_view what = error.what();
    refuse(fmt::format("byte {}", error.byte),
           fmt::format("malformed JSON: {}", shown(what.substr(std::min(what.find(": ") + 2, what.size())))),
           "the file is not glTF, or truncated");
  } catch (const Json::exception& error) {
    const std::string_view what = error.what();
    refuse({}, fmt::format("malformed JSON: {}", shown(what.substr(std::min(what.find("] ") + 2, what.size())))));
  }
  if (!json_.is_object())
    refuse({}, fmt::format("the JSON must be an object, not {}", json_.type_name()), "the file is not glTF");
}

void Document::check_asset() const {
  const Field asset = (*this)["asset"];
  if (!asset) refuse("asset", "is missing", "the file is not glTF 2.0");
  const std::string version = asset["minVersion"] ? asset["minVersion"].string() : asset["version"].string();
  if (version != "2.0" && !version.starts_with("2.")) {
    refuse("asset.version", fmt::format("is \"{}\"; only glTF 2 is supported", shown(version)),
           "convert the model to glTF 2.0");
  }
  if (asset["minVersion"] && version != "2.0") {
    refuse("asset.minVersion", fmt::format("asks for glTF {}; 2.0 is supported", shown(version)), "export as glTF 2.0");
  }
}

void Document::check_extensions() {
  const Field required = (*this)["extensionsRequired"];
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string name = required.at(i).string();
    if (!understands(name)) {
      refuse(required.at(i).path(),
             fmt::format("the model needs the extension {}, which is not supported", shown(name)),
             std::string(extension_remedy(name)));
    }
  }
  std::string ignored;
  const Field used = (*this)["extensionsUsed"];
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::string name = used.at(i).string();
    if (understands(name) && name != "KHR_texture_transform" && name != "KHR_materials_unlit") continue;
    ignored += (ignored.empty() ? "" : ", ") + shown(name);
  }
  if (!ignored.empty()) note("extensions left out: " + ignored);
}

std::span<const std::byte> Document::load(const Field& uri) {
  const std::string text = uri.string();
  if (is_data_uri(text)) {
    auto entry = embedded_.find(uri.path());
    if (entry == embedded_.end()) entry = embedded_.emplace(uri.path(), decode_data_uri(uri)).first;
    return entry->second;
  }
  check_reference(uri);
  if (source_.folder.empty()) {
    refuse(uri.path(), fmt::format("refers to the file \"{}\", but the model was not read from a folder", shown(text)),
           "read the model from a file, or use a GLB");
  }
  const Result<std::filesystem::path> path = find_reference(source_.folder, text);
  if (!path) refuse(uri.path(), path.error().message, path.error().remedy);
  auto entry = files_.find(*path);
  if (entry == files_.end()) {
    Result<std::vector<std::byte>> read = read_reference(source_.folder, text);
    if (!read) refuse(uri.path(), read.error().message, read.error().remedy);
    bytes_ += read->size();
    entry = files_.emplace(*path, *std::move(read)).first;
  }
  return entry->second;
}

void Document::load_buffers() {
  const Field buffers = (*this)["buffers"];
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const Field buffer = buffers.at(i);
    const Field uri = buffer["uri"];
    const std::uint64_t length = buffer["byteLength"].index();
    // Without a reference it is the GLB's own chunk, or a stand-in for compressed data that is not to be read.
    if (!uri && !(binary_ && i == 0 && chunk_.data() != nullptr)) {
      buffers_.emplace_back();
      continue;
    }
    const std::span<const std::byte> bytes = uri ? load(uri) : chunk_;
    if (length > bytes.size()) {
      refuse(buffer["byteLength"].path(), fmt::format("claims {} bytes, there are {}", length, bytes.size()),
             "the file is truncated, or its buffer belongs to another model");
    }
    buffers_.push_back(bytes.first(static_cast<std::size_t>(length)));
  }
}

void Document::check_picture_references() {
  const Field images = (*this)["images"];
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Field uri = images.at(i)["uri"];
    if (uri && !is_data_uri(uri.string())) check_reference(uri);
  }
}

/// The bytes that `owner` (a buffer view, or the extension that stands for one) names by buffer, byteOffset and
/// byteLength.
std::span<const std::byte> Document::buffer_range(const Field& owner) const {
  const std::size_t buffer = owner["buffer"].index_into((*this)["buffers"]);
  const std::uint64_t offset = owner["byteOffset"].index_or(0);
  const std::uint64_t length = owner["byteLength"].index();
  const std::span<const std::byte> bytes = buffers_[buffer];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    refuse(
        owner.path(),
        fmt::format("needs bytes {} to {} of buffer {}, which has {}", offset, offset + length, buffer, bytes.size()),
        "the file may be truncated");
  }
  return bytes.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

View Document::view(std::size_t index) {
  const Field field = (*this)["bufferViews"].at(index);
  const Field compressed = field["extensions"][kMeshopt];
#ifdef LIMN_WITH_MESHOPTIMIZER
  if (compressed) return decompress(index, compressed);
#else
  if (compressed && field["buffer"] && buffer_range(field).empty()) {
    refuse(field.path(), "is compressed by EXT_meshopt_compression", std::string(extension_remedy(kMeshopt)));
  }
#endif
  const std::uint64_t stride = field["byteStride"].index_or(0);
  if (stride > 252) refuse(field["byteStride"].path(), fmt::format("is {}, more than 252", stride));
  return {buffer_range(field), static_cast<std::size_t>(stride)};
}

#ifdef LIMN_WITH_MESHOPTIMIZER
namespace {

int decode_meshopt(std::vector<std::byte>& out, std::size_t count, std::size_t stride, std::span<const std::byte> in,
                   const std::string& mode) {
  const auto* const data = reinterpret_cast<const unsigned char*>(in.data());
  if (mode == "ATTRIBUTES") return meshopt_decodeVertexBuffer(out.data(), count, stride, data, in.size());
  if (mode == "TRIANGLES") return meshopt_decodeIndexBuffer(out.data(), count, stride, data, in.size());
  return meshopt_decodeIndexSequence(out.data(), count, stride, data, in.size());
}

bool apply_meshopt_filter(std::vector<std::byte>& out, std::size_t count, std::size_t stride,
                          const std::string& filter) {
  if (filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(out.data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(out.data(), count, stride);
  } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
    meshopt_decodeFilterExp(out.data(), count, stride);
  } else {
    return false;
  }
  return true;
}

}  // namespace

void Document::take_decompressed(std::uint64_t size, const std::string& where) {
  // No stream of the extension's codecs grows more than 64 times, so that only views which share one get further.
  constexpr std::uint64_t kFloor = std::uint64_t{16} << 20;
  const std::uint64_t most = kFloor + 64 * bytes_;
  if (size > most - decompressed_bytes_) {
    refuse(
        where,
        fmt::format("brings the decompressed data to more than {} bytes, too many for {} bytes of data", most, bytes_),
        "check the count; buffer views that share their compressed data must be one");
  }
  decompressed_bytes_ += size;
}

View Document::decompress(std::size_t index, const Field& extension) {
  const std::uint64_t stride = extension["byteStride"].index();
  const std::uint64_t count = extension["count"].index();
  const std::string mode = extension["mode"].string();
  const std::string filter = extension["filter"].string_or("NONE");
  const bool indices = mode == "TRIANGLES" || mode == "INDICES";
  if (!indices && mode != "ATTRIBUTES") refuse(extension["mode"].path(), fmt::format("is \"{}\"", shown(mode)));
  if (indices ? (stride != 2 && stride != 4) : (stride == 0 || stride > 256 || stride % 4 != 0)) {
    refuse(extension["byteStride"].path(), fmt::format("cannot be {}", stride));
  }
  if (mode == "TRIANGLES" && count % 3 != 0) refuse(extension["count"].path(), "must be a multiple of 3");
  auto entry = decompressed_.find(index);
  if (entry == decompressed_.end()) {
    const std::span<const std::byte> in = buffer_range(extension);
    // The codecs never shrink data further than this, so a larger claim cannot be decoded and must not be allocated.
    if (count > (64 * std::uint64_t{in.size()} + 4096) / stride * 4) {
      refuse(extension["count"].path(), fmt::format("claims {} elements in {} bytes", count, in.size()));
    }
    take_decompressed(count * stride, extension["count"].path());
    std::vector<std::byte> out(static_cast<std::size_t>(count * stride));
    if (decode_meshopt(out, static_cast<std::size_t>(count), static_cast<std::size_t>(stride), in, mode) != 0) {
      refuse(extension.path(), "holds compressed data that cannot be decoded", "the file may be damaged");
    }
    if (indices
            ? filter != "NONE"
            : !apply_meshopt_filter(out, static_cast<std::size_t>(count), static_cast<std::size_t>(stride), filter)) {
      refuse(extension["filter"].path(), fmt::format("\"{}\" does not fit", shown(filter)));
    }
    entry = decompressed_.emplace(index, std::move(out)).first;
  }
  return {entry->second, indices ? 0 : static_cast<std::size_t>(stride)};
}
#endif

Picture Document::picture(std::size_t index) {
  const auto known = pictures_.find(index);
  if (known != pictures_.end()) return known->second;
  return pictures_.emplace(index, read_picture((*this)["images"].at(index))).first->second;
}

Picture Document::read_picture(const Field& image) {
  Picture picture;
  if (const Field uri = image["uri"]) {
    const std::string text = uri.string();
    if (!is_data_uri(text) && !source_.folder.empty() && !reference_exists(source_.folder, text)) {
      note(fmt::format("picture \"{}\" left out: no such file", shown(text)));
      return picture;
    }
    picture.bytes = load(uri);
  } else {
    picture.bytes = view(image["bufferView"].index_into((*this)["bufferViews"])).bytes;
  }
  picture.mime = picture_mime(picture.bytes);
  if (!picture.mime.empty()) return picture;
  note(fmt::format("{} left out: neither PNG nor JPEG", image.path()));
  return {};
}

}  // namespace limn::formats::gltf
