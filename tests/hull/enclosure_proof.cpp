// Proves hulls of many meshes at three scales, and says what it looked at. Exit code 1 where anything is wrong.
//   hull_enclosure_proof [--first SEED] [--random N] [--samples N] [--strict] [--scales 1e-3,1,1e3] [--faces
//   4000,500,60] [MODEL…]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "limn/base/random.h"
#include "limn/mesh/import.h"

#include "hull/enclosure.h"
#include "hull/random_solids.h"

namespace limn::test {
namespace {

struct Settings {
  std::size_t first = 0, random = 12;  ///< seeds of random solids
  std::size_t samples = 300;
  bool strict = false;
  std::vector<double> scales{1e-3, 1, 1e3};
  std::vector<std::size_t> targets{4000, 500, 60};  ///< of models
  std::vector<std::string> models;
};

/// "1,2,3"
std::vector<double> numbers_of(const char* text) {
  std::vector<double> numbers;
  while (text != nullptr) {
    numbers.push_back(std::strtod(text, nullptr));
    text = std::strchr(text, ',');
    if (text != nullptr) ++text;
  }
  return numbers;
}

Settings settings_of(int count, char** arguments) {
  Settings settings;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const char* const value = i + 1 < count ? arguments[i + 1] : "0";
    if (argument == "--random") {
      settings.random = std::strtoull(value, nullptr, 10), ++i;
    } else if (argument == "--first") {
      settings.first = std::strtoull(value, nullptr, 10), ++i;
    } else if (argument == "--samples") {
      settings.samples = std::strtoull(value, nullptr, 10), ++i;
    } else if (argument == "--strict") {
      settings.strict = true;
    } else if (argument == "--scales") {
      settings.scales = numbers_of(value), ++i;
    } else if (argument == "--faces") {
      settings.targets.clear();
      for (const double faces : numbers_of(value))
        settings.targets.push_back(static_cast<std::size_t>(faces));
      ++i;
    } else {
      settings.models.push_back(argument);
    }
  }
  return settings;
}

Mesh scaled(Mesh mesh, double scale) {
  for (Vec3& p : mesh.positions)
    p = Vec3(DVec3(p) * scale);
  return mesh;
}

void print(const std::string& name, const EnclosureTally& tally, double seconds) {
  std::printf(
      "%-34s hulls %zu (%zu reached), vertices %zu, samples %zu, on the hull %zu, OUTSIDE %zu, of no inside %zu, "
      "strays %zu, "
      "elsewhere %zu, lost %zu, steps %zu, proved %zu, %.1f s%s%s\n",
      name.c_str(), tally.hulls, tally.reached, tally.vertices, tally.samples, tally.on_surface, tally.outside,
      tally.nothing_inside, tally.strays, tally.elsewhere, tally.lost, tally.steps, tally.proved, seconds,
      tally.refused.empty() ? "" : ("; refused: " + tally.refused).c_str(),
      tally.objection.empty() ? "" : ("; WRONG: " + tally.objection).c_str());
  std::fflush(stdout);
}

class Proof {
 public:
  explicit Proof(const Settings& settings) : settings_(settings) {}

  void look_at(const std::string& name, const Mesh& mesh, std::size_t faces, std::uint64_t seed, bool say) {
    const auto begun = std::chrono::steady_clock::now();
    EnclosureTally all;
    for (const double scale : settings_.scales) {
      EnclosureOptions options;
      options.faces = faces;
      options.samples = settings_.samples;
      options.elsewhere = settings_.samples / 5;
      options.strict = settings_.strict;
      all.add(prove_enclosure(scaled(mesh, scale), options, seed));
    }
    total_.add(all);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (say || all.strays > 0 || !all.objection.empty() || !all.refused.empty()) print(name, all, seconds);
  }

  const EnclosureTally& total() const { return total_; }

 private:
  const Settings& settings_;
  EnclosureTally total_;
};

int run(const Settings& settings) {
  const auto begun = std::chrono::steady_clock::now();
  Proof proof(settings);
  for (const std::string& path : settings.models) {
    const Result<ImportedMesh> model = read_mesh(path);
    if (!model) {
      std::fprintf(stderr, "%s\n", format_error(model.error()).c_str());
      return 2;
    }
    const std::string name = path.substr(path.find_last_of('/') + 1);
    for (const std::size_t faces : settings.targets)
      proof.look_at(name + " to " + std::to_string(faces), model->mesh, faces, 1, true);
  }
  for (std::uint64_t seed = settings.first; seed < settings.first + settings.random; ++seed) {
    const Mesh mesh = random_solid(seed);
    Random random(seed);
    const std::size_t targets[] = {4, 8, 20, mesh.faces.size() / 10, mesh.faces.size() / 3};
    const std::size_t faces = std::max<std::size_t>(4, targets[random.below(5)]);
    proof.look_at("random " + std::to_string(seed) + " to " + std::to_string(faces), mesh, faces, seed, false);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  print("all", proof.total(), seconds);
  return proof.total().objection.empty() && proof.total().hulls > 0 ? 0 : 1;
}

}  // namespace
}  // namespace limn::test

int main(int count, char** arguments) {
  return limn::test::run(limn::test::settings_of(count, arguments));
}
