#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/context.h"
#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/render/compaction.h"
#include "limn/silhouette/eye.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/silhouetteness.h"

namespace limn {

/// An object of a scene, read while a SceneExtractor is built and not needed after that.
struct SceneObject {
  const Topology* topology = nullptr;
  std::span<const Plane> planes;    ///< face_planes() of its mesh
  std::span<const Vec3> positions;  ///< of its mesh; needed for silhouetteness only
};

struct SceneExtractorOptions {
  bool silhouetteness = false;  ///< compute silhouetteness() of every edge too
  Wedge wedge = {};             ///< how wide it falls off
  bool around = false;          ///< allow extract_around()
};

/// Extracts the silhouettes of all objects of a scene on the graphics device, each seen from an eye of its own: facing
/// of every face, then silhouette and silhouetteness of every edge, then the compacted list of the silhouettes (Dyken
/// et al. 2008, sections 6.1 and 6.2; docs/gpu-extraction.md).
///
/// The objects' faces and edges are numbered one object after the other, in the order given: edge e of object o is
/// first_edge(o) + e. Belongs to the context's thread and must not outlive the context.
class SceneExtractor {
 public:
  /// Uploads the scene. Memory on the device, in bytes: 24 a face and 16 an edge; 20 more an edge with silhouetteness,
  /// 20 more a face and 8 an edge with `around`; and what each Compactor keeps besides its entries.
  /// \pre planes.size() == topology->face_count(); with silhouetteness, positions are those of the mesh
  /// Errors: kNoGraphics when the device cannot do or hold it, which the message explains.
  static Result<SceneExtractor> create(gl::Context& context, std::span<const SceneObject> objects,
                                       const SceneExtractorOptions& options = {});
  ~SceneExtractor();
  SceneExtractor(SceneExtractor&& other) noexcept;
  SceneExtractor& operator=(SceneExtractor&& other) noexcept;

  std::size_t object_count() const;
  std::size_t face_count() const;
  std::size_t edge_count() const;
  /// Where the object's faces and edges begin. \pre object <= object_count(); that of object_count() is the end
  FaceId first_face(std::size_t object) const;
  EdgeId first_edge(std::size_t object) const;

  /// Submits the extraction of one view; everything stays on the device, and later uses there need no barrier.
  ///
  /// The list holds exactly the edges that extract_silhouette_brute() finds for each object, whatever the device makes
  /// of subnormal numbers. \param eyes  one an object, in the object's space
  /// \pre eyes.size() == object_count()
  /// Cost: one upload of 16 bytes an object, two dispatches, and those of Compactor::run(): nothing waits for the
  /// device, and the number of calls depends neither on the objects nor on the view. Same bits each time.
  /// Errors: kNoGraphics when a method is first used and the device cannot hold its lists.
  Result<void> extract(std::span<const Eye> eyes, Compaction method = Compaction::kScan);

  /// Selects, for the eyes of the last extract(), the faces to be refined: those with an edge whose silhouetteness
  /// exceeds a threshold or, for none, with a silhouette edge; and every edge of these faces.
  /// Dyken's selection is `above` = 0. Boundary and non-manifold edges have silhouetteness 1.
  /// \pre built for it; extract() was called; with a threshold, the extractor was built for silhouetteness
  /// Cost: one dispatch and twice those of Compactor::run(). Errors: as extract().
  Result<void> extract_around(std::optional<float> above, Compaction method = Compaction::kScan);

  /// Lists in the device's memory, of ids over the whole scene, ascending: the silhouette edges, and what
  /// extract_around() selected. Valid until the next call of what made them.
  GpuList silhouettes() const;
  GpuList selected_faces() const;
  GpuList selected_edges() const;

  /// Names of buffers that extract() fills for use by other passes: a uint a face (1 front, 0 back), a float an edge
  /// (0 without silhouetteness).
  unsigned facing_buffer() const;
  unsigned silhouetteness_buffer() const;

  /// The silhouettes of each object, by the object's own ids, ascending; waits for the device.
  struct Lists {
    std::vector<EdgeId> edges;
    std::vector<std::size_t> offsets;  ///< where in `edges` each object begins; one more than there are objects
  };
  Lists read_silhouettes() const;

  /// The other results, over the whole scene; each waits for the device.
  std::vector<FaceId> read_selected_faces() const;
  std::vector<EdgeId> read_selected_edges() const;
  std::vector<std::uint8_t> read_facing() const;
  /// \pre built for silhouetteness. Within 4 units of 2^-24 of edge_silhouetteness() on devices whose arithmetic is
  /// that of IEEE 754 up to a rounding of divisions.
  std::vector<float> read_silhouetteness() const;

 private:
  struct Impl;
  explicit SceneExtractor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The silhouettes of one mesh from one eye, ascending: the set of extract_silhouette_brute(), through the graphics
/// device. For one view; for many, keep a SceneExtractor, since uploading the mesh costs more than extraction.
/// \pre planes.size() == topology.face_count()
/// Errors: kNoGraphics when the device cannot do or hold it (and from gl::Context::create() where there is none).
Result<std::vector<EdgeId>> extract_silhouette_gpu(gl::Context& context, const Topology& topology,
                                                   std::span<const Plane> planes, const Eye& eye,
                                                   Compaction method = Compaction::kScan);

}  // namespace limn
