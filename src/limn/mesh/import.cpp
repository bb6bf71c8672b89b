#include "limn/mesh/import.h"

#include <cctype>
#include <exception>
#include <new>
#include <utility>

#include "limn/base/file.h"
#include "limn/mesh/formats/finish.h"
#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/stl_kind.h"
#include "limn/mesh/formats/text.h"

namespace limn {
namespace {

using formats::Source;

bool looks_like_off(std::string_view word) {
  const std::size_t off = word.find("OFF");
  return off != std::string_view::npos && word.substr(0, off).find_first_not_of("STCN4n") == std::string_view::npos;
}

/// OBJ has no magic word: the first line that is no comment has to begin with one of its statements.
bool looks_like_obj(std::string_view text) {
  constexpr std::size_t kLookedAt = 1u << 16;
  formats::TextLines lines(text.substr(0, kLookedAt));
  while (lines.advance('#')) {
    const std::string_view word = lines.token();
    for (const std::string_view known : {"v", "vn", "vt", "f", "o", "g", "s", "mtllib", "usemtl"}) {
      if (word == known) return true;
    }
    return false;
  }
  return false;
}

/// The format the content speaks for; kUnknown when it is none that limn reads itself.
MeshFormat sniff(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return MeshFormat::kPly;
  if (text.starts_with("glTF")) return MeshFormat::kGlb;
  if (formats::stl_kind_of(bytes) != formats::StlKind::kNeither) return MeshFormat::kStl;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return MeshFormat::kUnknown;
  if (text[first] == '{') return MeshFormat::kGltf;
  formats::TextLines lines(text);
  if (lines.advance('#') && looks_like_off(lines.peek())) return MeshFormat::kOff;
  return looks_like_obj(text) ? MeshFormat::kObj : MeshFormat::kUnknown;
}

Result<ImportedMesh> call_reader(const Source& source, MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return formats::read_ply(source);
    case MeshFormat::kStl:
      return formats::read_stl(source);
    case MeshFormat::kOff:
      return formats::read_off(source);
    case MeshFormat::kObj:
      return formats::read_obj(source);
    case MeshFormat::kGltf:
    case MeshFormat::kGlb:
      return formats::read_gltf(source);
    case MeshFormat::kOther:
    case MeshFormat::kUnknown:
      break;
  }
  return formats::read_other(source);
}

/// Reads and finishes; what a library or the allocator throws becomes an error.
Result<ImportedMesh> read_and_finish(const Source& source, MeshFormat format) {
  try {
    Result<ImportedMesh> imported = call_reader(source, format);
    if (!imported) return imported;
    if (!report(source.progress, "checking", 0.0)) return fail(ErrorCode::kCancelled, "reading was cancelled");
    if (const Result<void> good = formats::finish(*imported, source.name); !good) return tl::unexpected(good.error());
    return imported;
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kUnreadable, "not enough memory to read the file");
  } catch (const std::exception& exception) {
    return fail(ErrorCode::kUnreadable, exception.what());
  }
}

Result<ImportedMesh> read_source(const Source& source, MeshFormat told) {
  if (source.bytes.empty()) return fail_at(ErrorCode::kUnreadable, source.name, {}, "the file is empty");
  const bool open = told == MeshFormat::kUnknown || told == MeshFormat::kOther;
  const MeshFormat seen = sniff(source.bytes);
  Result<ImportedMesh> imported = read_and_finish(source, open ? seen : told);
  if (imported) return imported;
  Error& error = imported.error();
  if (error.file.empty()) error.file = source.name;
  // Two formats for one glTF file: not a contradiction.
  const bool gltf = (seen == MeshFormat::kGltf || seen == MeshFormat::kGlb) &&
                    (told == MeshFormat::kGltf || told == MeshFormat::kGlb);
  if (!open && !gltf && seen != told && seen != MeshFormat::kUnknown && error.code == ErrorCode::kUnreadable) {
    error.remedy = "it was read as " + std::string(format_name(told)) + " but looks like " +
                   std::string(format_name(seen)) + ": rename it or name its format";
  }
  return imported;
}

}  // namespace

std::string_view format_name(MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return "PLY";
    case MeshFormat::kStl:
      return "STL";
    case MeshFormat::kOff:
      return "OFF";
    case MeshFormat::kObj:
      return "OBJ";
    case MeshFormat::kGltf:
      return "glTF";
    case MeshFormat::kGlb:
      return "GLB";
    case MeshFormat::kOther:
      return "another format";
    case MeshFormat::kUnknown:
      break;
  }
  return "an unknown format";
}

MeshFormat format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::pair<std::string_view, MeshFormat> kExtensions[] = {
      {".ply", MeshFormat::kPly}, {".stl", MeshFormat::kStl},   {".off", MeshFormat::kOff},
      {".obj", MeshFormat::kObj}, {".gltf", MeshFormat::kGltf}, {".glb", MeshFormat::kGlb},
  };
  for (const auto& [text, format] : kExtensions) {
    if (extension == text) return format;
  }
  return extension.size() > 1 ? MeshFormat::kOther : MeshFormat::kUnknown;
}

Result<ImportedMesh> read_mesh(const std::filesystem::path& path, const ImportOptions& options) {
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return tl::unexpected(file.error());
  const bool standard_input = path == "-";
  Source source{.bytes = file->bytes(), .name = path.string(), .folder = {}, .progress = options.progress};
  if (standard_input) {
    source.name = "standard input";
  } else {
    source.folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  }
  const MeshFormat told = options.format == MeshFormat::kUnknown && !standard_input ? format_of(path) : options.format;
  return read_source(source, told);
}

Result<ImportedMesh> read_mesh(std::span<const std::byte> bytes, MeshFormat format, std::string_view name) {
  return read_source({.bytes = bytes, .name = std::string(name), .folder = {}, .progress = {}}, format);
}

}  // namespace limn
