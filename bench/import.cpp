/// How long does a model take from its file to a mesh with connectivity, and how much memory? limn beside assimp and
/// tinyobjloader, on the same mesh as binary PLY and as OBJ.
///
///   bench_import [--faces N] [--rounds N] [--json]
///
/// Every run is a process of its own, so that no contestant inherits another's heap or threads; contestants alternate
/// within each round. Files lie in the page cache: the first round, not counted, reads them.
#include "limn/mesh/import.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "limn/base/file.h"
#include "limn/base/parallel.h"
#include "limn/mesh/export.h"
#include "limn/mesh/shapes.h"
#include "limn/mesh/topology.h"

#ifdef LIMN_BENCH_ASSIMP
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#endif
#ifdef LIMN_BENCH_TINYOBJLOADER
#include <tiny_obj_loader.h>
#endif

namespace {

namespace fs = std::filesystem;

struct Options {
  std::size_t faces = 1'000'000;
  int rounds = 9;
  bool json = false;
};

/// One contestant: reads a file and gives the number of triangles it got, 0 for a failure.
struct Contestant {
  std::string name;
  fs::path file;
  std::function<std::size_t(const fs::path&)> run;
  std::vector<double> times_ms = {};
  std::vector<double> peaks_bytes = {};
};

/// What a run's process reports.
struct Outcome {
  double time_ms = 0;
  double peak_bytes = 0;
  std::size_t faces = 0;
};

/// A line "NAME:   N kB" of /proc/self/status, in bytes.
double memory_now(std::string_view name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.starts_with(name)) return std::strtod(line.c_str() + name.size() + 1, nullptr) * 1024;
  }
  return 0;
}

/// Runs in a process of its own and gives back what it wrote: its result, as bytes.
Outcome in_own_process(const std::function<Outcome()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    const Outcome outcome = work();
    const bool sent = ::write(ends[1], &outcome, sizeof outcome) == static_cast<ssize_t>(sizeof outcome);
    ::_exit(sent ? 0 : 1);
  }
  ::close(ends[1]);
  Outcome outcome;
  if (::read(ends[0], &outcome, sizeof outcome) != static_cast<ssize_t>(sizeof outcome)) outcome = {};
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return outcome;
}

Outcome measure(const Contestant& contestant) {
  return in_own_process([&] {
    const double before = memory_now("VmRSS");
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome;
    outcome.faces = contestant.run(contestant.file);
    outcome.time_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    outcome.peak_bytes = memory_now("VmHWM") - before;
    return outcome;
  });
}

std::size_t limn_read(const fs::path& file) {
  const auto imported = limn::read_mesh(file);
  return imported ? imported->mesh.face_count() : 0;
}

std::size_t limn_read_and_connect(const fs::path& file) {
  const auto imported = limn::read_mesh(file);
  return imported ? limn::build_topology(imported->mesh).face_count() : 0;
}

std::size_t limn_on_one_thread(const fs::path& file) {
  const limn::ThreadLimit one(1);
  return limn_read_and_connect(file);
}

#ifdef LIMN_BENCH_ASSIMP
std::size_t assimp_read(const fs::path& file, unsigned flags) {
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(file.string(), flags);
  std::size_t faces = 0;
  for (unsigned i = 0; scene && i < scene->mNumMeshes; ++i)
    faces += scene->mMeshes[i]->mNumFaces;
  return faces;
}
#endif

#ifdef LIMN_BENCH_TINYOBJLOADER
std::size_t tinyobj_read(const fs::path& file) {
  tinyobj::ObjReader reader;
  if (!reader.ParseFromFile(file.string())) return 0;
  std::size_t faces = 0;
  for (const tinyobj::shape_t& shape : reader.GetShapes())
    faces += shape.mesh.num_face_vertices.size();
  return faces;
}
#endif

std::vector<Contestant> contestants(const fs::path& ply, const fs::path& obj) {
  std::vector<Contestant> all;
  all.push_back({"limn: read", ply, limn_read});
  all.push_back({"limn: read, topology", ply, limn_read_and_connect});
  all.push_back({"limn: read, topology, one thread", ply, limn_on_one_thread});
#ifdef LIMN_BENCH_ASSIMP
  all.push_back({"assimp: plain", ply, [](const fs::path& file) { return assimp_read(file, 0); }});
  all.push_back({"assimp: triangulate, join vertices", ply, [](const fs::path& file) {
                   return assimp_read(file, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
                 }});
#endif
  all.push_back({"limn: read, topology", obj, limn_read_and_connect});
#ifdef LIMN_BENCH_TINYOBJLOADER
  all.push_back({"tinyobjloader: read", obj, tinyobj_read});
#endif
#ifdef LIMN_BENCH_ASSIMP
  all.push_back({"assimp: triangulate, join vertices", obj, [](const fs::path& file) {
                   return assimp_read(file, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
                 }});
#endif
  return all;
}

/// A torus with normals, as PLY and OBJ; made in a process of its own to leave this one small. Gives its number of
/// faces.
std::size_t write_models(const fs::path& ply, const fs::path& obj, std::size_t faces) {
  const auto write_both = [&] {
    auto mesh = limn::make_shape(limn::Shape::kTorus, {.faces = faces, .seed = 1});
    if (!mesh) return Outcome{};
    mesh->uvs = {};
    const bool written = limn::write_mesh(*mesh, ply) && limn::write_mesh(*mesh, obj);
    return written ? Outcome{0, 0, mesh->face_count()} : Outcome{};
  };
  return in_own_process(write_both).faces;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

void print_table(const std::vector<Contestant>& all, std::size_t faces, int rounds) {
  fmt::print("{} triangles, {} rounds\n\n", faces, rounds);
  fmt::print("| file | contestant | median ms | fastest–slowest | peak bytes a triangle |\n|---|---|---|---|---|\n");
  for (const Contestant& c : all) {
    fmt::print("| {} | {} | {:.1f} | {:.1f}–{:.1f} | {:.0f} |\n", c.file.extension().string().substr(1), c.name,
               quantile(c.times_ms, 0.5), quantile(c.times_ms, 0), quantile(c.times_ms, 1),
               quantile(c.peaks_bytes, 0.5) / static_cast<double>(faces));
  }
}

void print_json(const std::vector<Contestant>& all, std::size_t faces, int rounds) {
  fmt::print("{{\"faces\": {}, \"rounds\": {}, \"contestants\": [", faces, rounds);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Contestant& c = all[i];
    fmt::print(
        "{}\n  {{\"name\": \"{}\", \"file\": \"{}\", \"median_ms\": {:.3f}, \"min_ms\": {:.3f}, \"max_ms\": {:.3f}, "
        "\"peak_bytes_per_triangle\": {:.1f}}}",
        i > 0 ? "," : "", c.name, c.file.extension().string().substr(1), quantile(c.times_ms, 0.5),
        quantile(c.times_ms, 0), quantile(c.times_ms, 1), quantile(c.peaks_bytes, 0.5) / static_cast<double>(faces));
  }
  fmt::print("\n]}}\n");
}

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--json") {
      options.json = true;
    } else if ((word == "--faces" || word == "--rounds") && i + 1 < argc) {
      const long value = std::strtol(argv[++i], nullptr, 10);
      if (value <= 0) return false;
      if (word == "--faces") options.faces = static_cast<std::size_t>(value);
      if (word == "--rounds") options.rounds = static_cast<int>(value);
    } else {
      return false;
    }
  }
  return true;
}

/// Runs all rounds; false, having said so, when a contestant gets another number of triangles than the file holds.
bool race(std::vector<Contestant>& all, std::size_t faces, int rounds) {
  for (int round = -1; round < rounds; ++round) {
    for (Contestant& contestant : all) {
      const Outcome outcome = measure(contestant);
      if (outcome.faces != faces) {
        fmt::print(stderr, "{}: {} triangles instead of {} from {}\n", contestant.name, outcome.faces, faces,
                   contestant.file.string());
        return false;
      }
      if (round < 0) continue;
      contestant.times_ms.push_back(outcome.time_ms);
      contestant.peaks_bytes.push_back(outcome.peak_bytes);
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) {
    fmt::print(stderr, "usage: bench_import [--faces N] [--rounds N] [--json]\n");
    return 2;
  }
  std::string folder = (fs::temp_directory_path() / "limn-bench-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) return 1;
  const fs::path ply = fs::path(folder) / "model.ply";
  const fs::path obj = fs::path(folder) / "model.obj";
  const std::size_t faces = write_models(ply, obj, options.faces);
  std::vector<Contestant> all = contestants(ply, obj);
  const bool good = faces > 0 && race(all, faces, options.rounds);
  if (good && options.json) print_json(all, faces, options.rounds);
  if (good && !options.json) print_table(all, faces, options.rounds);
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return good ? 0 : 1;
}
