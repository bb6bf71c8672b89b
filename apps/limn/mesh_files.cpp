#include "mesh_files.h"

#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "limn/asset/asset_file.h"
#include "limn/base/file.h"
#include "limn/mesh/repair.h"

#include "interrupt.h"

namespace limn::cli {
namespace {

Option& add_format(OptionTable& table, std::string name, MeshFormat& target, std::string what) {
  return table.choice(std::move(name), target,
                      {{"ply", MeshFormat::kPly},
                       {"stl", MeshFormat::kStl},
                       {"off", MeshFormat::kOff},
                       {"obj", MeshFormat::kObj},
                       {"gltf", MeshFormat::kGltf},
                       {"glb", MeshFormat::kGlb}},
                      std::move(what));
}

Result<void> check_folder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
    return fail_at(ErrorCode::kUnwritable, path, {}, "its folder does not exist", "create the folder first");
  }
  if (std::filesystem::is_directory(path, ignored)) {
    return fail_at(ErrorCode::kUnwritable, path, {}, "is a directory", "name a file in it");
  }
  // What is no regular file (a device, a pipe) is written into; anything else is put beside its place and renamed.
  const bool special = std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
  const std::string written = special ? path : folder.empty() ? "." : folder.string();
  if (::access(written.c_str(), W_OK) != 0) {
    return fail_at(ErrorCode::kUnwritable, path, {}, special ? "may not be written" : "its folder may not be written",
                   "choose another place");
  }
  return {};
}

Result<void> check_free_stdout(const Session& session) {
  if (!session.json()) return {};
  return fail(ErrorCode::kInvalidArgument, "--json and -o - both want standard output", "write the output to a file");
}

/// The asset of a file whose mesh was read.
std::optional<ClipAsset> load_asset(Session& session, const InputOptions& options, MeshFormat format) {
  if (format != MeshFormat::kGlb || options.path == "-") return std::nullopt;
  const Result<FileBytes> file = FileBytes::open(options.path);
  if (!file || !holds_clip_asset(file->bytes())) return std::nullopt;
  Result<ClipAsset> asset = read_clip_asset(file->bytes(), options.path);
  if (asset) return *std::move(asset);
  session.say(format_error(asset.error()) + " (read as a mesh)");
  return std::nullopt;
}

}  // namespace

void add_input_options(OptionTable& table, InputOptions& options) {
  add_format(table, "--input-format", options.format, "of the input where its name does not tell");
  table.toggle("--repair", options.repair, "remove useless faces, turn flipped ones; says what it changed");
}

void add_output_options(OptionTable& table, OutputOptions& options, bool required) {
  table.file("-o,--output", options.path, "file to write; its extension gives the format; - is standard output")
      .required = required;
  add_format(table, "--format", options.format, "of the output where its name does not tell");
  table.toggle("--ascii", options.ascii, "PLY and STL as text");
}

Result<LoadedMesh> load(Session& session, const InputOptions& options) {
  ImportOptions import;
  import.format = options.format;
  import.progress = session.progress();
  Result<ImportedMesh> read = read_mesh(options.path, import);
  if (!read) return tl::unexpected(read.error());
  const std::string name = options.path == "-" ? "standard input" : options.path;
  LoadedMesh loaded{std::move(read->mesh), read->format, std::move(read->notes), {}, {}};
  loaded.asset = load_asset(session, options, loaded.format);
  if (loaded.asset) {  // nothing is lost: the extension was read, and tangents follow from the rest
    std::erase(loaded.notes, "extensions left out: LIMN_silhouette");
    std::erase(loaded.notes, "attributes left out: TANGENT");
  }
  for (const std::string& note : loaded.notes)
    session.say(fmt::format("{}: {}", name, note));
  if (options.repair) {
    Repair repaired = repair(loaded.mesh);
    loaded.mesh = std::move(repaired.mesh);
    loaded.repairs = std::move(repaired.changes);
    if (loaded.repairs.empty()) session.say(fmt::format("{}: repair: nothing to change", name));
    for (const std::string& change : loaded.repairs)
      session.say(fmt::format("{}: repair: {}", name, change));
  }
  return loaded;
}

Result<LoadedMesh> load_with_faces(Session& session, const InputOptions& options) {
  Result<LoadedMesh> loaded = load(session, options);
  if (loaded && loaded->mesh.faces.empty()) {
    return fail_at(ErrorCode::kUnsuitable, options.path == "-" ? "standard input" : options.path, {}, "has no faces",
                   "export it as a triangle mesh");
  }
  return loaded;
}

Result<void> check_output(const Session& session, const OutputOptions& options) {
  if (options.path == "-") {
    if (options.format != MeshFormat::kUnknown) return check_free_stdout(session);
    return fail(ErrorCode::kInvalidArgument, "-o - does not tell a format", "add --format, for example --format ply");
  }
  const MeshFormat format = options.format != MeshFormat::kUnknown ? options.format : format_of(options.path);
  if (format == MeshFormat::kUnknown || format == MeshFormat::kOther) {
    return fail_at(ErrorCode::kInvalidArgument, options.path, {}, "its extension is of no format that can be written",
                   "name it .ply, .stl, .off, .obj, .gltf or .glb, or add --format");
  }
  return check_folder(options.path);
}

Result<void> check_destination(const Session& session, const std::string& path) {
  return path == "-" ? check_free_stdout(session) : check_folder(path);
}

Result<void> check_picture_output(const Session& session, const std::string& path, std::string_view extension) {
  if (path == "-") return check_free_stdout(session);
  if (std::filesystem::path(path).extension() != extension) {
    return fail_at(ErrorCode::kInvalidArgument, path, {}, fmt::format("its name does not end in {}", extension),
                   fmt::format("give it a name that ends in {}", extension));
  }
  return check_folder(path);
}

Error about(Error error, const std::string& path) {
  if (error.code == ErrorCode::kUnsuitable && error.file.empty()) error.file = path == "-" ? "standard input" : path;
  return error;
}

Result<void> save(Session& session, const Mesh& mesh, const OutputOptions& options) {
  if (Result<void> going = session.check_stop(); !going) return going;
  ExportOptions exported;
  exported.format = options.format;
  exported.ascii = options.ascii;
  exported.progress = session.progress();
  const Unstoppable writing;
  return write_mesh(mesh, options.path, exported);
}

std::string counted(std::size_t count, std::string_view noun) {
  const std::string plain = fmt::format("{}", count);
  std::string digits;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (i > 0 && (plain.size() - i) % 3 == 0) digits += ',';
    digits += plain[i];
  }
  if (count == 1) return fmt::format("{} {}", digits, noun);
  if (noun.ends_with("vertex")) return fmt::format("{} {}vertices", digits, noun.substr(0, noun.size() - 6));
  return fmt::format("{} {}s", digits, noun);
}

}  // namespace limn::cli
