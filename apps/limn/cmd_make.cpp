#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "limn/mesh/shapes.h"

#include "mesh_files.h"
#include "nearest.h"
#include "verb.h"

namespace limn::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::uint64_t kMostFaces = 100'000'000;

struct MakeOptions {
  std::string shape;
  std::uint64_t faces = 0;
  std::uint64_t seed = 1;
  bool list = false;
  OutputOptions output;
};

Result<int> list_shapes(Session& session) {
  ordered_json json{{"shapes", ordered_json::array()}};
  std::string text;
  for (const ShapeInfo& shape : shapes()) {
    json["shapes"].push_back({{"name", shape.name}, {"what", shape.what}});
    text += fmt::format("{:<12}{}\n", shape.name, shape.what);
  }
  return (session.json() ? session.print_json(json) : session.print(text)).map([] { return kExitDone; });
}

Result<Shape> find_shape(const std::string& name) {
  std::vector<std::string_view> known;
  for (const ShapeInfo& shape : shapes()) {
    if (shape.name == name) return shape.shape;
    known.push_back(shape.name);
  }
  return fail(ErrorCode::kInvalidArgument, fmt::format("make: no such shape '{}'", name),
              suggest(name, known) + " (limn make --list shows all)");
}

Result<void> report(Session& session, const MakeOptions& options, const Mesh& mesh) {
  session.say(fmt::format("{}: {}, {}", options.output.path, counted(mesh.face_count(), "triangle"),
                          counted(mesh.positions.size(), "vertex")));
  if (!session.json()) return {};
  return session.print_json(ordered_json{{"shape", options.shape},
                                         {"output", options.output.path},
                                         {"faces", mesh.face_count()},
                                         {"vertices", mesh.positions.size()},
                                         {"seed", options.seed}});
}

Result<int> run(Session& session, const MakeOptions& options) {
  if (options.list) return list_shapes(session);
  if (options.shape.empty() || options.output.path.empty()) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("make: {} is missing", options.shape.empty() ? "SHAPE" : "-o FILE"),
                "usage: limn make SHAPE -o FILE [--faces N]; limn make --list shows the shapes");
  }
  const Result<Shape> shape = find_shape(options.shape);
  if (!shape) return tl::unexpected(shape.error());
  const Result<void> checked = check_output(session, options.output);
  if (!checked) return tl::unexpected(checked.error());
  const Result<Mesh> mesh = make_shape(*shape, {static_cast<std::size_t>(options.faces), options.seed});
  if (!mesh) return tl::unexpected(mesh.error());
  return save(session, *mesh, options.output).and_then([&] { return report(session, options, *mesh); }).map([] {
    return kExitDone;
  });
}

Run declare_make(OptionTable& table) {
  const auto options = std::make_shared<MakeOptions>();
  Option& shape = table.argument("SHAPE", options->shape, "what to make", ValueKind::kChoice);
  shape.required = false;
  for (const ShapeInfo& info : shapes())
    shape.choices.emplace_back(info.name);
  table.count("--faces", options->faces, 1, kMostFaces, "about this many triangles (default: the shape's own)");
  table.count("--seed", options->seed, 0, UINT64_MAX, "of asteroid and terrain (default 1)");
  table.toggle("--list", options->list, "print the shapes' names and what they are");
  table.begin(Group::kFiles);
  add_output_options(table, options->output, false);
  return [options](Session& session) { return run(session, *options); };
}

}  // namespace

Verb make_verb() {
  return Verb{"make",
              "makes a mesh: cube, torus, knot, terrain and others",
              "SHAPE -o FILE [--faces N] [--seed N]",
              true,
              {{{"limn make asteroid --faces 5000 --seed 7 -o asteroid.glb", "a rock, another one for every seed"},
                {"limn make --list", "the shapes"},
                {"limn make torus --format ply -o - | limn info -", "without a file in between"}}},
              declare_make};
}

}  // namespace limn::cli
