#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limn/asset/clip_asset.h"
#include "limn/mesh/export.h"
#include "limn/mesh/import.h"

#include "option_table.h"
#include "session.h"

namespace limn::cli {

/// A mesh to read.
struct InputOptions {
  std::string path;
  MeshFormat format = MeshFormat::kUnknown;
  bool repair = false;
};

/// A mesh that was read, and what happened to it on the way; both lists have been said on standard error.
struct LoadedMesh {
  Mesh mesh;
  MeshFormat format = MeshFormat::kUnknown;
  std::vector<std::string> notes;
  std::vector<std::string> repairs;
  std::optional<ClipAsset> asset;  ///< where the file is a clip asset; `mesh` is its hull

  /// What cameras fit: the mesh, or what the asset was made of, so that pictures of both line up.
  const Mesh& framed() const { return asset ? asset->levels.front().mesh : mesh; }
};

/// A mesh to write.
struct OutputOptions {
  std::string path;
  MeshFormat format = MeshFormat::kUnknown;
  bool ascii = false;
};

/// --input-format, and --repair; the argument itself is added by the verb.
void add_input_options(OptionTable& table, InputOptions& options);
/// -o, --format, --ascii. \param required whether -o must be given
void add_output_options(OptionTable& table, OutputOptions& options, bool required = true);

/// Reads a mesh, repairs it when asked to, and says what the reader and the repair did. A file that is a clip asset is
/// read as one, too; what is wrong with it as such is said, and leaves its mesh. Standard input is a mesh alone.
/// Errors: those of read_mesh().
Result<LoadedMesh> load(Session& session, const InputOptions& options);
/// As above; a mesh without faces is kUnsuitable.
Result<LoadedMesh> load_with_faces(Session& session, const InputOptions& options);

/// Whether an output can be written, asked before long work begins: format known, folder there, and standard output not
/// wanted for two things at once. Errors: kInvalidArgument, kUnwritable.
Result<void> check_output(const Session& session, const OutputOptions& options);
Result<void> save(Session& session, const Mesh& mesh, const OutputOptions& options);

/// The error, naming the input it is about where it is a mesh's fault.
Error about(Error error, const std::string& path);

/// Whether something can be written there: its folder is there, and standard output not wanted for two things at once.
Result<void> check_destination(const Session& session, const std::string& path);

/// check_output for a file that is no mesh. \param extension what its name must end in (".png")
Result<void> check_picture_output(const Session& session, const std::string& path, std::string_view extension);

/// "1 triangle", "2 triangles", with thousands apart: "69,666 triangles".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace limn::cli
