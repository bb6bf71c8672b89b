#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "limn/mesh/topology.h"
#include "limn/silhouette/eye.h"

namespace limn::bench {

/// vtkPolyDataSilhouette in a Python of its own (Debian: python3-vtk9), so that it can take turns with limn view by
/// view. It times its own update; starting and talking are not counted.
class VtkSilhouette {
 public:
  struct Turn {
    double ms = 0;
    std::size_t lines = 0;
  };

  /// Nothing when Python or VTK is missing. The mesh is handed over welded.
  static std::optional<VtkSilhouette> start(const Mesh& mesh, const Topology& topology);

  VtkSilhouette(VtkSilhouette&& other) noexcept;
  VtkSilhouette& operator=(VtkSilhouette&&) = delete;
  ~VtkSilhouette();

  /// One view. Nothing when the process has died. \pre !eye.orthographic
  std::optional<Turn> turn(const Eye& eye);

  const std::string& version() const { return version_; }

 private:
  VtkSilhouette() = default;
  std::filesystem::path mesh_file_;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
  int process_ = -1;
  std::string version_;
};

}  // namespace limn::bench
