#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "limn/gl/context.h"
#include "limn/render/clip/clip_frame.h"
#include "limn/render/gpu_mesh.h"

#include "clip_subjects.h"

namespace limn::bench {

/// What frames took, with quartiles.
struct Spread {
  double median = 0, low = 0, high = 0;
};
Spread spread_of(std::vector<double> values);

/// A mesh as a careful program draws it: indexed, a normal a vertex, back faces culled, lit by the same stage as hulls.
class PlainMesh {
 public:
  static Result<PlainMesh> create(gl::Context& context, const Mesh& mesh);
  void draw(const RenderTargets& targets, const CameraBuffer& camera) const;

 private:
  explicit PlainMesh(GpuMesh mesh) : mesh_(std::move(mesh)) {}
  GpuMesh mesh_;
  std::unique_ptr<MaterialTable> materials_;
  const gl::Program* program_ = nullptr;
};

struct FrameSettings {
  int size_px = 512;
  int views = 60;
  std::uint64_t seed = 1;
};

/// A row of the table: everything from the camera on until the device is done, contestants alternating view by view.
struct ClipRow {
  std::string name;
  std::size_t faces = 0, hull_faces = 0;
  Spread original, simplified, clipped, lines, msaa_original, msaa_clipped;  ///< ms a frame
  /// The same as processor time of all threads: for machines that others use as well.
  double cpu_original = 0, cpu_simplified = 0, cpu_clipped = 0, cpu_lines = 0, cpu_msaa_original = 0,
         cpu_msaa_clipped = 0;
  double extraction = 0, loops = 0, stencil = 0, hull = 0;  ///< medians of stages, waiting for the device between them
  double silhouette_edges = 0, stencil_triangles = 0, edge_on_faces = 0;
  PublishedRow paper;
};
/// The median of frames of a mesh as a careful program draws it, or of an asset with its one silhouette.
Result<double> time_plain(gl::Context& context, const Mesh& mesh, const Bounds& bounds, const FrameSettings& settings);
Result<double> time_clipped(gl::Context& context, const ClipAsset& asset, const FrameSettings& settings);

Result<ClipRow> measure_row(gl::Context& context, const Subject& subject, const FrameSettings& settings);

}  // namespace limn::bench
