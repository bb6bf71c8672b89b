#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "limn/asset/clip_asset.h"
#include "limn/base/result.h"

namespace limn::bench {

/// What Sander et al. 2000 report of a model in Table 1, in milliseconds.
struct PublishedRow {
  double original = 0, extraction = 0, stencil = 0, coarse = 0, total = 0, speed_up = 0, antialiasing = 0;
};

/// A model to clip: which, how small a hull, and what the paper says of it.
struct SubjectName {
  std::string name;
  std::size_t faces = 0;  ///< of the original: 0 for the file's own
  std::size_t hull_faces = 0;
  PublishedRow paper{};
};

/// A model with what the contestants draw.
struct Subject {
  SubjectName about;
  Mesh original;    ///< welded, a normal a vertex, faces and vertices in the order that caches like best
  Mesh simplified;  ///< as many faces as the hull, likewise
  ClipAsset asset;
};

/// The rows of the table: the paper's models or what stands for them, and others of their kinds.
std::vector<SubjectName> table_subjects();

/// Reads or makes a model. Errors: those of reading it; kUnsuitable where it is not closed.
Result<Mesh> original_of(const SubjectName& about, const std::filesystem::path& models);

/// The whole subject, its asset as `limn clip` makes it, with a picture of normals and no other map.
/// \param levels  silhouettes at most  Errors: as original_of(), and those of build_clip_asset().
Result<Subject> make_subject(const SubjectName& about, const std::filesystem::path& models, std::size_t levels = 1);

/// A mesh of `faces` faces by plain simplification, ready to draw: a normal a vertex, ordered for caches.
Mesh simplified_to(const Mesh& original, std::size_t faces);

}  // namespace limn::bench
