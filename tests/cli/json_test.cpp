// What --json prints, held against the tables of docs/json.md: every key documented, of the type named, none missing.
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "cli/program.h"
#include "support/temp_folder.h"

namespace limn::test {
namespace {

using nlohmann::json;

struct Key {
  std::set<std::string> types;
  bool optional = false;
};
using Schema = std::map<std::string, Key>;

/// "string or null, optional"
Key parse_type(std::string text) {
  Key key;
  const std::size_t comma = text.find(", optional");
  key.optional = comma != std::string::npos;
  text = text.substr(0, comma);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(" or ", at), text.size());
    key.types.insert(text.substr(at, end - at));
    at = end + 4;
  }
  return key;
}

/// The table under "## VERB".
Schema documented(const std::string& verb) {
  std::istringstream page(slurp(std::string(LIMN_SOURCE_DIR) + "/docs/json.md"));
  Schema schema;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) inside = line == "## " + verb;
    if (!inside || !line.starts_with("| `")) continue;
    const std::size_t end = line.find("` | ");
    const std::size_t type_end = line.find(" |", end + 4);
    schema[line.substr(3, end - 3)] = parse_type(line.substr(end + 4, type_end - end - 4));
  }
  EXPECT_FALSE(schema.empty()) << verb;
  return schema;
}

std::string type_of(const json& value) {
  if (value.is_null()) return "null";
  if (value.is_string()) return "string";
  if (value.is_boolean()) return "boolean";
  if (value.is_number_integer()) return "integer";
  if (value.is_number()) return "number";
  return value.is_array() ? "array" : "object";
}

void walk(const json& value, const std::string& path, const Schema& schema, std::set<std::string>& seen) {
  if (!path.empty() && !(path.ends_with("[]") && value.is_object())) {
    const auto key = schema.find(path);
    ASSERT_NE(key, schema.end()) << path << " is not documented";
    const std::string type = type_of(value);
    const bool number = type == "integer" && key->second.types.contains("number");
    EXPECT_TRUE(number || key->second.types.contains(type)) << path << " is of type " << type;
    seen.insert(path);
  }
  if (value.is_array()) {
    for (const json& element : value)
      walk(element, path + "[]", schema, seen);
  }
  if (value.is_object()) {
    for (const auto& [name, member] : value.items())
      walk(member, path.empty() ? name : path + "." + name, schema, seen);
  }
}

void expect_schema(const json& value, const std::string& verb) {
  const Schema schema = documented(verb);
  std::set<std::string> seen;
  walk(value, "", schema, seen);
  for (const auto& [path, key] : schema)
    EXPECT_TRUE(key.optional || seen.contains(path)) << verb << ": " << path << " is missing";
}

class Json : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(limn.run({"make", "knot", "--faces", "600", "-o", "knot.ply"}).exit, 0);
    folder.write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\nf 1 1 2\n");
    folder.write("empty.off", "OFF\n0 0 0\n");
  }
  TempFolder folder;
  Program limn{folder.path()};
};

TEST_F(Json, OfInfoIsAsDocumented) {
  expect_schema(limn.json({"info", "knot.ply"}), "info");
  expect_schema(limn.json({"info", "broken.obj", "--repair"}), "info");
  expect_schema(limn.json({"info", "empty.off"}), "info");
}

TEST_F(Json, OfMakeIsAsDocumented) {
  expect_schema(limn.json({"make", "cube", "-o", "cube.obj"}), "make");
  expect_schema(limn.json({"make", "--list"}), "make");
}

TEST_F(Json, OfRefineIsAsDocumented) {
  expect_schema(limn.json({"refine", "knot.ply", "-o", "fine.ply", "--view", "0,0"}), "refine");
  expect_schema(limn.json({"refine", "broken.obj", "-o", "fine.ply", "--view", "0,0", "--repair"}), "refine");
}

TEST_F(Json, OfBakeIsAsDocumented) {
  expect_schema(limn.json({"bake", "knot.ply", "knot.ply", "-o", "baked.glb", "--size", "128"}), "bake");
  expect_schema(limn.json({"bake", "knot.ply", "knot.ply", "-o", "maps", "--size", "128", "--maps", "displacement,ao",
                           "--ao-rays", "1", "--fail-if", "miss>100%", "--repair"}),
                "bake");
}

#ifdef LIMN_WITH_GL

TEST_F(Json, OfDemoIsAsDocumented) {
  expect_schema(limn.json({"demo", "--size", "300x100"}), "demo");
}

TEST_F(Json, OfRenderIsAsDocumented) {
  expect_schema(limn.json({"render", "knot.ply", "-o", "knot.png", "--size", "64x48", "--outline"}), "render");
  expect_schema(limn.json({"render", "knot.ply", "-o", "knot.png", "--size", "64x48", "--method", "patterns"}),
                "render");
}

#endif

#ifdef LIMN_WITH_EMBREE

TEST_F(Json, OfSilhouetteIsAsDocumented) {
  expect_schema(limn.json({"silhouette", "knot.ply", "-o", "knot.svg"}), "silhouette");
  expect_schema(limn.json({"silhouette", "knot.ply", "-o", "knot.dxf", "--ortho", "--scale", "10:1"}), "silhouette");
  expect_schema(limn.json({"silhouette", "broken.obj", "-o", "b.ply", "--repair"}), "silhouette");
}

TEST_F(Json, OfAListOfEdgesIsAsDocumented) {
  limn.json({"silhouette", "knot.ply", "-o", "knot.json", "--all", "--classes", "silhouette,crease"});
  expect_schema(json::parse(slurp(folder / "knot.json")), "A list of edges: silhouette -o FILE.json");
}

#endif

TEST_F(Json, OfHullIsAsDocumented) {
  expect_schema(limn.json({"hull", "knot.ply", "-o", "hull.ply", "--faces", "200"}), "hull");
  expect_schema(limn.json({"hull", "knot.ply", "--faces", "200", "--sequence", "knot.hulls", "--inner"}), "hull");
  expect_schema(limn.json({"hull", "knot.hulls", "-o", "hull.ply", "--faces", "300"}), "hull");
}

TEST_F(Json, OfClipIsAsDocumented) {
  expect_schema(limn.json({"clip", "knot.ply", "-o", "knot.glb", "--faces", "200", "--size", "64"}), "clip");
  expect_schema(limn.json({"info", "knot.glb"}), "info");
}

TEST_F(Json, OfCompareIsAsDocumented) {
  expect_schema(limn.json({"compare", "knot.ply", "knot.ply", "--views", "2", "--size", "64"}), "compare");
}

TEST_F(Json, OfCompareIsPrintedWhenAGateFails) {
  const Outcome outcome =
      limn.run({"compare", "knot.ply", "knot.ply", "--views", "2", "--size", "64", "--json", "--fail-if", "iou>0.5"});
  EXPECT_EQ(outcome.exit, 5);
  const json value = json::parse(outcome.out);
  expect_schema(value, "compare");
  EXPECT_EQ(value["failed"], json::array({"iou>0.5"}));
}

TEST_F(Json, OfTheOthersIsAsDocumented) {
  expect_schema(limn.json({"help"}), "help");
  expect_schema(limn.json({"help", "refine"}), "help");
  expect_schema(limn.json({"version"}), "version");
  expect_schema(limn.json({"completion", "bash"}), "completion");
  expect_schema(limn.json({"man", "make"}), "man");
}

TEST_F(Json, StaysValidWhenAFileNameIsNotUtf8) {
  const std::string name = "knot\xff.ply";
  ASSERT_EQ(limn.run({"make", "cube", "-o", name}).exit, 0);
  EXPECT_EQ(limn.json({"info", name})["faces"], 12);
}

}  // namespace
}  // namespace limn::test
