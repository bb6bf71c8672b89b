#include "vtk_silhouette.h"

#include <array>
#include <csignal>
#include <fstream>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace limn::bench {
namespace {

void write_mesh_file(const std::filesystem::path& path, const Mesh& mesh, const Topology& topology) {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&](const void* data, std::size_t size) {
    out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  };
  const std::array<std::uint64_t, 2> counts = {mesh.positions.size(), topology.faces.size()};
  put(counts.data(), sizeof(counts));
  put(mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
  put(topology.faces.data(), topology.faces.size() * sizeof(Triangle));
}

}  // namespace

std::optional<VtkSilhouette> VtkSilhouette::start(const Mesh& mesh, const Topology& topology) {
  VtkSilhouette vtk;
  vtk.mesh_file_ = std::filesystem::temp_directory_path() / ("limn-vtk-" + std::to_string(getpid()) + ".mesh");
  write_mesh_file(vtk.mesh_file_, mesh, topology);
  std::array<int, 2> to{}, from{};
  if (pipe(to.data()) != 0 || pipe(from.data()) != 0) return std::nullopt;
  std::signal(SIGPIPE, SIG_IGN);  // a Python without VTK ends at once
  vtk.process_ = fork();
  if (vtk.process_ == 0) {
    dup2(to[0], STDIN_FILENO);
    dup2(from[1], STDOUT_FILENO);
    for (const int end : {to[0], to[1], from[0], from[1]})
      close(end);
    // The system's Python is the one that Debian's package serves.
    execl("/usr/bin/python3", "python3", LIMN_BENCH_SCRIPTS "/vtk_silhouette.py", vtk.mesh_file_.c_str(), nullptr);
    _exit(127);
  }
  close(to[0]);
  close(from[1]);
  vtk.to_ = fdopen(to[1], "w");
  vtk.from_ = fdopen(from[0], "r");
  std::array<char, 64> version{};
  if (vtk.process_ < 0 || std::fscanf(vtk.from_, "ready %63s", version.data()) != 1) return std::nullopt;
  vtk.version_ = version.data();
  return vtk;
}

VtkSilhouette::VtkSilhouette(VtkSilhouette&& other) noexcept
    : mesh_file_(std::exchange(other.mesh_file_, {})),
      to_(std::exchange(other.to_, nullptr)),
      from_(std::exchange(other.from_, nullptr)),
      process_(std::exchange(other.process_, -1)),
      version_(std::move(other.version_)) {}

VtkSilhouette::~VtkSilhouette() {
  if (to_ != nullptr) std::fclose(to_);
  if (from_ != nullptr) std::fclose(from_);
  if (process_ > 0) waitpid(process_, nullptr, 0);
  std::error_code ignored;
  if (!mesh_file_.empty()) std::filesystem::remove(mesh_file_, ignored);
}

std::optional<VtkSilhouette::Turn> VtkSilhouette::turn(const Eye& eye) {
  std::fprintf(to_, "%.9g %.9g %.9g\n", static_cast<double>(eye.at.x), static_cast<double>(eye.at.y),
               static_cast<double>(eye.at.z));
  std::fflush(to_);
  Turn turn;
  if (std::fscanf(from_, "%lf %zu", &turn.ms, &turn.lines) != 2) return std::nullopt;
  return turn;
}

}  // namespace limn::bench
