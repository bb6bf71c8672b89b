// scratch
#include <fmt/format.h>
#include <cstdlib>
#include <chrono>
#include "limn/base/random.h"
#include "limn/mesh/import.h"
#include "limn/mesh/shapes.h"
#include "limn/render/clip/clip_picture.h"
#include <glm/geometric.hpp>
using namespace limn;
int main(int argc, char** argv) {
  auto context = gl::Context::create();
  int views = argc > 2 ? atoi(argv[2]) : 50;
  int size = argc > 3 ? atoi(argv[3]) : 512;
  bool exact = argc > 4 ? atoi(argv[4]) : 1;
  bool ortho = argc > 5 ? atoi(argv[5]) : 0;
  Mesh mesh;
  std::string name = argv[1];
  if (name == "knot") mesh = *make_shape(Shape::kKnot, {.faces = 185856});
  else if (name == "holes3") mesh = *make_shape(Shape::kHoles3, {.faces = 188416});
  else if (name == "asteroid") mesh = *make_shape(Shape::kAsteroid, {.faces = 100000});
  else { auto m = read_mesh(name); if (!m) { fmt::print("{}\n", format_error(m.error())); return 1; } mesh = std::move(m->mesh); }
  mesh.normals = {}; mesh.uvs = {}; mesh.colors = {}; mesh.materials.clear(); mesh.face_materials.clear();
  ClipAsset asset;
  asset.levels.push_back({mesh, 0});
  asset.bounds = face_bounds(mesh);
  Mesh hull = *make_shape(Shape::kIcosphere, {.faces = 320});
  hull.uvs = {};
  float r = 0; Vec3 mid = asset.bounds.center();
  for (auto& p : mesh.positions) r = std::max(r, glm::length(p - mid));
  for (auto& p : hull.positions) p = mid + 1.06f * r * p;
  asset.hull = hull;
  auto t0 = std::chrono::steady_clock::now();
  auto model = ClipModel::create(**context, asset);
  if (!model) { fmt::print("{}\n", format_error(model.error())); return 1; }
  fmt::print("{} faces, create {:.0f} ms\n", mesh.face_count(), std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - t0).count());
  Random random(7);
  ClipInstance inst{&*model};
  std::size_t bad = 0, bad_views = 0; double tri = 0, eo = 0, lm = 0, em = 0, sm = 0, hm = 0, edges = 0;
  for (int i = 0; i < views; ++i) {
    CameraFit fit; fit.orthographic = ortho;
    Camera camera = fit_camera(asset.bounds, random.direction(), fit);
    camera.far_distance *= 2; camera.near_distance *= 0.5;
    RenderOptions o; o.width = o.height = size; o.samples = 1; o.background = Vec4(0);
    ClipOptions c; c.exact = exact; c.level_tolerance_px = 0; c.time_stages = true;
    auto a = render(**context, mesh, camera, o);
    auto b = render_clipped(**context, std::span(&inst, 1), camera, o, c);
    if (!a || !b) { fmt::print("fail {}\n", format_error(!a ? a.error() : b.error())); return 1; }
    std::size_t n = 0;
    for (int y = 0; y < size; ++y) for (int x = 0; x < size; ++x) {
      bool ca = a->pixel(x, y)[3] > 0, cb = b->image.pixel(x, y)[3] > 0;
      if (ca != cb) { if (n < 3) fmt::print("view {} pixel {} {} original {} clipped {} place {}\n", i, x, y, ca, cb, (int)b->drawn[0].place); ++n; }
    }
    bad += n; bad_views += n > 0;
    auto& d = b->drawn[0];
    if (i > 0) { tri += d.stencil_triangles; eo += d.edge_on_faces; lm += d.loops_ms; em += d.extraction_ms; sm += d.stencil_ms; hm += d.hull_ms; edges += d.silhouette_edges; }
    if (i == 0) { write_png(*a, "/tmp/clip_a.png"); write_png(b->image, "/tmp/clip_b.png"); }
  }
  double k = views - 1;
  fmt::print("differing {} in {} views of {}; edges {:.0f} tri {:.0f} edge-on {:.0f} extract {:.3f} loops+edge-on {:.3f} stencil {:.3f} hull {:.3f} ms\n", bad, bad_views, views, edges/k, tri/k, eo/k, em/k, lm/k, sm/k, hm/k);
  if ((*context)->severe_messages()) fmt::print("{}\n", (*context)->last_severe_message());
}
