#include "limn/mesh/export.h"

#include <exception>
#include <new>
#include <stdlib.h>
#include <utility>

#include "limn/base/file.h"
#include "limn/mesh/formats/formats.h"

namespace limn {
namespace {

namespace fs = std::filesystem;
using formats::OutputFile;

Result<std::vector<OutputFile>> call_writer(const Mesh& mesh, const fs::path& path, MeshFormat format, bool ascii) {
  switch (format) {
    case MeshFormat::kPly:
      return formats::write_ply(mesh, path, ascii);
    case MeshFormat::kStl:
      return formats::write_stl(mesh, path, ascii);
    case MeshFormat::kOff:
      return formats::write_off(mesh, path);
    case MeshFormat::kObj:
      return formats::write_obj(mesh, path);
    case MeshFormat::kGltf:
      return formats::write_gltf(mesh, path, false);
    case MeshFormat::kGlb:
      return formats::write_gltf(mesh, path, true);
    case MeshFormat::kOther:
    case MeshFormat::kUnknown:
      break;
  }
  return fail_at(ErrorCode::kInvalidArgument, path.string(), {}, "no format to write",
                 "use one of .ply .stl .off .obj .gltf .glb, or name the format");
}

/// A folder beside the destination, removed with what is left in it.
class StagingFolder {
 public:
  explicit StagingFolder(const fs::path& beside) {
    std::string name = (beside / ".limn-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~StagingFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

tl::unexpected<Error> unwritable(const fs::path& path, const std::error_code& error) {
  return fail_at(ErrorCode::kUnwritable, path.string(), {}, error.message());
}

/// Follows a link, so that the file it names is replaced and the link stays.
fs::path behind_link(const fs::path& path) {
  std::error_code error;
  return fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
}

/// Writes all files into a folder of their own, then moves them to their places, the main file last: a failure before
/// the moves leaves everything as it was.
Result<void> write_together(const std::vector<OutputFile>& files) {
  const fs::path main = behind_link(files.front().path);
  const StagingFolder staging(main.has_parent_path() ? main.parent_path() : fs::path("."));
  if (staging.path().empty()) {
    return fail_at(ErrorCode::kUnwritable, files.front().path.string(), {}, "its folder cannot be written",
                   "create the folder first, or choose another");
  }
  std::vector<std::pair<fs::path, fs::path>> moves;
  for (const OutputFile& file : files) {
    std::error_code error;
    const fs::path target = behind_link(file.path);
    const fs::path staged = staging.path() / std::to_string(moves.size());
    const fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status)) return unwritable(file.path, std::make_error_code(std::errc::is_a_directory));
    if (Result<void> done = write_file(staged, file.bytes); !done) {
      done.error().file = file.path.string();
      return done;
    }
    error.clear();
    if (fs::is_regular_file(status)) fs::permissions(staged, status.permissions(), error);
    if (error) return unwritable(file.path, error);
    moves.emplace_back(staged, target);
  }
  for (auto move = moves.rbegin(); move != moves.rend(); ++move) {
    std::error_code error;
    fs::rename(move->first, move->second, error);
    if (error) return unwritable(move->second, error);
  }
  return {};
}

/// Whether a rename can put a file here: a device or a pipe has to be written into.
bool can_be_replaced(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return path != "-" && (!fs::exists(status) || fs::is_regular_file(status) || fs::is_directory(status));
}

}  // namespace

Result<void> write_mesh(const Mesh& mesh, const std::filesystem::path& path, const ExportOptions& options) {
  const MeshFormat format = options.format == MeshFormat::kUnknown && path != "-" ? format_of(path) : options.format;
  try {
    if (!report(options.progress, "writing", 0.0)) return fail(ErrorCode::kCancelled, "writing was cancelled");
    const Result<std::vector<OutputFile>> files = call_writer(mesh, path, format, options.ascii);
    if (!files) return tl::unexpected(files.error());
    if (!report(options.progress, "writing", 0.5)) return fail(ErrorCode::kCancelled, "writing was cancelled");
    // Into a stream goes the main file alone: there is no "beside".
    if (files->size() > 1 && can_be_replaced(path)) return write_together(*files);
    return write_file(path, files->front().bytes);
  } catch (const std::bad_alloc&) {
    return fail_at(ErrorCode::kUnwritable, path.string(), {}, "not enough memory to write the mesh");
  } catch (const std::exception& exception) {
    return fail_at(ErrorCode::kUnwritable, path.string(), {}, exception.what());
  }
}

}  // namespace limn
