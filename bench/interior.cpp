// How near does a clipped hull come to the original's picture inside its outline?
//
//   interior [--only NAME…] [--models DIR] [--size PX] [--views N] [--seed N] [--map PX] [--texels T] [--steps N]
//            [--no-parts] [--picture FILE.png] [--picture-view N] [--json]
//
// From each random view: the original; its hull as published; in 8 and 32 parts with capped cuts, each with a hull and
// a count of its own; and with lines of sight followed through the shell. docs/interior-silhouettes.md says what is
// measured.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

#include "limn/asset/build.h"
#include "limn/base/random.h"
#include "limn/gl/timer.h"
#include "limn/hull/shell.h"
#include "limn/image/image.h"
#include "limn/render/picture.h"

#include "clip_frames.h"

namespace limn::bench {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::vector<std::string> only;
  std::string models = "models", picture;
  FrameSettings frames;
  int picture_view = 0;
  int map_px = 1024;
  InteriorOptions march;
  bool no_parts = false, json = false;
};

/// A picture and how far away what it shows is; 0 where there is nothing.
struct Seen {
  std::vector<double> distance;
  Image image;
};

Result<Seen> read(gl::Context& context, const RenderTargets& targets, const Camera& camera) {
  std::vector<float> z(static_cast<std::size_t>(targets.width()) * static_cast<std::size_t>(targets.height()));
  glGetTextureImage(targets.depth().id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(4 * z.size()),
                    z.data());
  auto image = targets.resolve(context, Vec4(1));
  if (!image) return tl::unexpected(image.error());
  Seen seen{std::vector<double>(z.size()), std::move(*image)};
  const double n = double{camera.near_distance}, f = double{camera.far_distance};
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double depth = double{z[i]};
    seen.distance[i] = depth >= 1.0 ? 0.0 : 2 * n * f / (f + n - (2.0 * depth - 1.0) * (f - n));
  }
  return seen;
}

/// What pictures add up to.
struct Sums {
  double both = 0, wrong = 0, colour = 0;  ///< pixels; squared differences of a channel
  std::size_t covered_otherwise = 0;
  std::vector<double> time_ms;
};

void compare(const Seen& original, const Seen& clipped, double apart, Sums& sums) {
  const auto width = static_cast<std::size_t>(original.image.width);
  const auto height = static_cast<std::size_t>(original.image.height);
  for (std::size_t i = 0; i < original.distance.size(); ++i) {
    const bool there = original.distance[i] > 0, here = clipped.distance[i] > 0;
    if (there != here) ++sums.covered_otherwise;
    if (!there || !here) continue;
    sums.both += 1;
    if (std::abs(original.distance[i] - clipped.distance[i]) > apart) sums.wrong += 1;
    const std::size_t pixel = 4 * ((height - 1 - i / width) * width + i % width);  // pictures run from the top
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = double(original.image.rgba[pixel + c]) - double(clipped.image.rgba[pixel + c]);
      sums.colour += d * d / 3;
    }
  }
}

/// What of a closed mesh lies where side * x[axis] >= side * at, open where it was cut: make_shell() caps it. Each loop
/// of the cut gets a cap of its own; where one lies within another the two turn opposite ways, and windings come out
/// right.
Mesh cut_away(const Mesh& mesh, int axis, float at, float side) {
  Mesh part;
  part.positions = mesh.positions;
  std::map<std::pair<VertexId, VertexId>, VertexId> crossings;
  const auto kept = [&](VertexId v) { return side * mesh.positions[v][axis] >= side * at; };
  const auto crossing = [&](VertexId a, VertexId b) {
    const auto [found, added] = crossings.emplace(std::minmax(a, b), static_cast<VertexId>(part.positions.size()));
    if (added) {
      const DVec3 p(mesh.positions[std::min(a, b)]), q(mesh.positions[std::max(a, b)]);
      Vec3 x(p + (q - p) * ((double{at} - p[axis]) / (q[axis] - p[axis])));
      x[axis] = at;
      part.positions.push_back(x);
    }
    return found->second;
  };
  for (const Triangle& t : mesh.faces) {
    std::vector<VertexId> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId a = t[c], b = t[(c + 1) % 3];
      if (kept(a)) corners.push_back(a);
      if (kept(a) != kept(b)) corners.push_back(crossing(a, b));
    }
    for (std::size_t c = 2; c < corners.size(); ++c)
      part.faces.push_back({corners[0], corners[c - 1], corners[c]});
  }
  return part;
}

/// 2^depth parts, cut across the longest side of what each spans, in the middle of its vertices.
Result<void> split(const Mesh& mesh, int depth, std::vector<Mesh>& parts) {
  const auto shell = make_shell(mesh);
  if (!shell) return tl::unexpected(shell.error());
  Mesh closed;
  closed.positions = shell->positions;
  closed.faces = shell->faces;
  if (depth == 0) {
    parts.push_back(std::move(closed));
    return {};
  }
  const Bounds bounds = face_bounds(closed);
  const Vec3 size = bounds.high - bounds.low;
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  std::vector<float> places;
  for (const Triangle& t : closed.faces)
    places.push_back(closed.positions[t[0]][axis]);
  const auto middle = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
  std::nth_element(places.begin(), middle, places.end());
  if (auto done = split(cut_away(closed, axis, *middle, 1.0f), depth - 1, parts); !done) return done;
  return split(cut_away(closed, axis, *middle, -1.0f), depth - 1, parts);
}

Result<ClipModel> make_model(gl::Context& context, const Mesh& mesh, std::size_t hull_faces, int map_px) {
  const auto built = build_clip_asset(mesh, {.faces = hull_faces, .levels = 1, .size_px = map_px});
  if (!built) return tl::unexpected(built.error());
  return ClipModel::create(context, built->asset);
}

/// A way to draw the original: of how many models, and how each.
struct Way {
  std::string name;
  InteriorOptions interior;
  std::vector<ClipModel> models;
  Sums sums{};
};

/// 2^depth parts that share faces and texels.
Result<std::vector<ClipModel>> make_parts(gl::Context& context, const Mesh& original, std::size_t hull_faces, int depth,
                                          int map_px) {
  std::vector<Mesh> parts;
  if (auto done = split(original, depth, parts); !done) return tl::unexpected(done.error());
  std::vector<ClipModel> models;
  for (const Mesh& part : parts) {
    auto model = make_model(context, part, std::max<std::size_t>(12, hull_faces / parts.size()), map_px);
    if (!model) return tl::unexpected(model.error());
    models.push_back(std::move(*model));
  }
  return models;
}

Result<std::vector<Way>> make_ways(gl::Context& context, const Mesh& original, const SubjectName& about,
                                   const Arguments& arguments) {
  std::vector<Way> ways;
  for (const auto interior : {ClipInterior::kHull, ClipInterior::kMarch}) {
    InteriorOptions options = arguments.march;
    options.way = interior;
    ways.push_back({interior == ClipInterior::kHull ? "hull" : "march", options, {}});
    auto model = make_model(context, original, about.hull_faces, arguments.map_px);
    if (!model) return tl::unexpected(model.error());
    ways.back().models.push_back(std::move(*model));
  }
  for (const int depth : {3, 5}) {
    if (arguments.no_parts) break;
    auto parts = make_parts(context, original, about.hull_faces, depth, arguments.map_px >> ((depth + 1) / 2));
    if (!parts) return tl::unexpected(parts.error());
    ways.push_back({fmt::format("{} parts", parts->size()), {.way = ClipInterior::kHull}, std::move(*parts)});
  }
  return ways;
}

Result<void> draw(ClipFrame& frame, const RenderTargets& targets, const Camera& camera, Way& way) {
  ClipDrawOptions options;
  options.level_tolerance_px = 0;
  options.interior = way.interior;
  gl::finish();
  const auto begun = Clock::now();
  frame.begin(targets, camera, options);
  for (ClipModel& model : way.models) {
    if (auto drawn = frame.draw(model); !drawn) return tl::unexpected(drawn.error());
  }
  frame.end();
  gl::finish();
  way.sums.time_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begun).count());
  return {};
}

Result<std::vector<Way>> measure(gl::Context& context, const SubjectName& about, const Arguments& arguments) {
  auto original = original_of(about, arguments.models);
  if (!original) return tl::unexpected(original.error());
  auto ways = make_ways(context, *original, about, arguments);
  if (!ways) return tl::unexpected(ways.error());
  const double scale = ways->front().models.front().unit_scale();
  for (Vec3& p : original->positions)
    p = scaled(p, scale);
  const auto plain = PlainMesh::create(context, *original);
  if (!plain) return tl::unexpected(plain.error());
  const int size = arguments.frames.size_px;
  const auto targets = RenderTargets::create(size, size, 1, RenderTargets::Stencil::kEightBits);
  if (!targets) return tl::unexpected(targets.error());
  auto frame = ClipFrame::create(context);
  if (!frame) return tl::unexpected(frame.error());
  const Bounds bounds = face_bounds(*original);
  const CameraBuffer buffer;
  Random random(arguments.frames.seed);
  for (int view = 0; view < arguments.frames.views; ++view) {
    Camera camera = fit_camera(bounds, random.direction());
    camera.near_distance *= 0.7f;  // the hull reaches beyond the bounds
    camera.far_distance *= 1.2f;
    buffer.update(make_camera_block(camera, size, size));
    plain->draw(*targets, buffer);
    const auto truth = read(context, *targets, camera);
    if (!truth) return tl::unexpected(truth.error());
    std::vector<Image> pictures = {truth->image};
    for (Way& way : *ways) {
      if (auto drawn = draw(*frame, *targets, camera, way); !drawn) return tl::unexpected(drawn.error());
      const auto seen = read(context, *targets, camera);
      if (!seen) return tl::unexpected(seen.error());
      compare(*truth, *seen, 0.02 * bounds.diagonal(), way.sums);
      if (way.models.size() == 1) pictures.push_back(seen->image);
    }
    if (arguments.picture.empty() || view != arguments.picture_view) continue;
    if (auto written = write_png(side_by_side(pictures, 4), arguments.picture); !written)
      return tl::unexpected(written.error());
  }
  return ways;
}

nlohmann::ordered_json json_of(const SubjectName& about, const std::vector<Way>& ways) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Way& way : ways) {
    const Spread time = spread_of({way.sums.time_ms.begin() + 1, way.sums.time_ms.end()});
    rows.push_back({{"model", about.name},
                    {"way", way.name},
                    {"wrong_layer", way.sums.wrong / way.sums.both},
                    {"colour_rms", std::sqrt(way.sums.colour / way.sums.both)},
                    {"covered_otherwise_px", way.sums.covered_otherwise},
                    {"frame_ms", {time.median, time.low, time.high}}});
  }
  return rows;
}

int run(const Arguments& arguments) {
  const auto context = gl::Context::create();
  if (!context) {
    fmt::print(stderr, "interior: {}\n", format_error(context.error()));
    return 6;
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  int status = 0;
  for (const SubjectName& about : table_subjects()) {
    const auto& only = arguments.only;
    if (!only.empty() && std::find(only.begin(), only.end(), about.name) == only.end()) continue;
    const auto ways = measure(**context, about, arguments);
    if (!ways) {
      fmt::print(stderr, "interior: {}: {}\n", about.name, format_error(ways.error()));
      status = 1;
      continue;
    }
    for (const auto& row : json_of(about, *ways)) {
      all.push_back(row);
      if (arguments.json) continue;
      fmt::print(
          "{:22} {:9} wrong layer {:7.3f} %  colour {:5.2f}  covered otherwise {} px  {:.1f} ms ({:.1f}-{:.1f})\n",
          about.name, row["way"].get<std::string>(), 100 * row["wrong_layer"].get<double>(),
          row["colour_rms"].get<double>(), row["covered_otherwise_px"].get<std::size_t>(),
          row["frame_ms"][0].get<double>(), row["frame_ms"][1].get<double>(), row["frame_ms"][2].get<double>());
    }
  }
  if (arguments.json) fmt::print("{}\n", all.dump(2));
  return status;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  limn::bench::Arguments arguments;
  arguments.frames.views = 24;
  CLI::App app{"How near a clipped hull comes to the original's picture inside its outline"};
  app.add_option("--only", arguments.only, "models by name");
  app.add_option("--models", arguments.models, "folder of models");
  app.add_option("--size", arguments.frames.size_px, "side of the picture")->check(CLI::Range(16, 4096));
  app.add_option("--views", arguments.frames.views, "random views")->check(CLI::Range(2, 100000));
  app.add_option("--seed", arguments.frames.seed, "of the views");
  app.add_option("--map", arguments.map_px, "side of the maps")->check(CLI::Range(64, 8192));
  app.add_option("--texels", arguments.march.texels_a_step, "a step of the march");
  app.add_option("--steps", arguments.march.steps, "of the march at most");
  app.add_option("--picture", arguments.picture, "PNG: original, hull, march");
  app.add_option("--picture-view", arguments.picture_view, "which view that shows, from 0");
  app.add_flag("--no-parts", arguments.no_parts, "leave the parts out");
  app.add_flag("--json", arguments.json, "figures as JSON");
  CLI11_PARSE(app, argc, argv);
  return limn::bench::run(arguments);
}
