// SVG pages: well-formed, in millimetres, one layer a class and visibility, the same bytes again.
#include "limn/drawing/svg.h"

#include <charconv>
#include <cmath>
#include <gtest/gtest.h>
#include <regex>
#include <string>
#include <vector>

#include "limn/mesh/shapes.h"

#include "drawing/lines.h"

namespace limn::test {
namespace {

using DVec2 = glm::dvec2;

/// Why a text is no well-formed XML of elements, attributes and text; empty when it is.
std::string xml_fault(const std::string& text) {
  std::vector<std::string> open;
  std::size_t at = text.find("?>");
  if (!text.starts_with("<?xml ") || at == std::string::npos) return "no declaration";
  at += 2;
  const std::regex tag(R"(<(/?)([A-Za-z][A-Za-z0-9:]*)((?:\s+[A-Za-z:-]+="[^"<&]*")*)\s*(/?)>)");
  const std::regex content(R"((?:[^<>&]|&(?:amp|lt|gt);)*)");
  bool root_seen = false;
  while (at < text.size()) {
    const std::size_t next = std::min(text.find('<', at), text.size());
    const std::string between = text.substr(at, next - at);
    if (!std::regex_match(between, content)) return "bad text: " + between;
    if (next == text.size()) break;
    const std::size_t end = text.find('>', next);
    if (end == std::string::npos) return "a tag without end";
    std::smatch match;
    const std::string whole = text.substr(next, end + 1 - next);
    // Long path data would make the expression recurse too deeply.
    const std::string shortened = std::regex_replace(whole, std::regex("[-0-9. lMZ]{40,}"), "0");
    if (!std::regex_match(shortened, match, tag)) return "bad tag: " + shortened;
    if (match[1] == "/") {
      if (open.empty() || open.back() != match[2]) return "a wrong end tag: " + shortened;
      open.pop_back();
    } else if (match[4] != "/") {
      if (open.empty() && root_seen) return "two roots";
      root_seen = true;
      open.push_back(match[2]);
    }
    at = end + 1;
  }
  return open.empty() ? "" : "an element without end: " + open.back();
}

Page one_of_each() {
  Polylines lines;
  float y = 0;
  for (const LineClass line_class : kLineClasses) {
    for (const bool visible : {true, false}) {
      add_line(lines, {{0, y, 0}, {10, y, 0}, {10, y + 1, 0}}, line_class, visible);
      y += 2;
    }
  }
  add_line(lines, {{20, 0, 0}, {30, 0, 0}, {25, 12.3456f, 0}}, LineClass::kSilhouette, true, true);
  PageOptions options = life_size();
  options.margin_mm = 2.5;
  return *lay_out(lines, from_above(), options);
}

/// The paths of an SVG as points, y upwards.
std::vector<std::vector<DVec2>> paths_of(const std::string& svg, double height_mm) {
  std::vector<std::vector<DVec2>> paths;
  for (std::size_t at = svg.find(" d=\""); at != std::string::npos; at = svg.find(" d=\"", at + 1)) {
    std::string data = svg.substr(at + 4, svg.find('"', at + 4) - at - 4);
    std::replace_if(
        data.begin(), data.end(), [](char c) { return c == 'M' || c == 'l' || c == 'Z'; }, ' ');
    std::vector<double> numbers;
    const char* next = data.data();
    const char* const end = next + data.size();
    while (next != end) {
      if (*next == ' ') {
        ++next;
        continue;
      }
      double value = NAN;
      const auto read = std::from_chars(next, end, value);
      EXPECT_NE(read.ptr, next) << data;
      if (read.ptr == next) return paths;
      numbers.push_back(value);
      next = read.ptr;
    }
    std::vector<DVec2> points;
    DVec2 pen(0.0);
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
      pen += DVec2(numbers[i], numbers[i + 1]);
      points.emplace_back(pen.x, height_mm - pen.y);
    }
    paths.push_back(points);
  }
  return paths;
}

TEST(Svg, HasALayerForEachClassAndVisibilityAndHiddenOnesBeneath) {
  const std::string svg = svg_text(one_of_each());
  EXPECT_EQ(xml_fault(svg), "");
  std::size_t last_hidden = 0;
  std::size_t first_visible = svg.size();
  for (std::size_t number = 0; number < kLayerCount; ++number) {
    const auto layer = static_cast<Layer>(number);
    const std::size_t at = svg.find("<g id=\"" + layer_name(layer) + "\" inkscape:groupmode=\"layer\"");
    ASSERT_NE(at, std::string::npos) << layer_name(layer);
    const std::string group = svg.substr(at, svg.find('>', at) - at);
    EXPECT_EQ(group.find("stroke-dasharray") == std::string::npos, is_visible(layer)) << group;
    if (is_visible(layer)) {
      first_visible = std::min(first_visible, at);
    } else {
      last_hidden = std::max(last_hidden, at);
    }
  }
  EXPECT_LT(last_hidden, first_visible);
}

TEST(Svg, LeavesOutEmptyLayers) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {10, 0, 0}});
  const std::string svg = svg_text(*lay_out(lines, from_above()));
  EXPECT_NE(svg.find("silhouette-visible"), std::string::npos);
  EXPECT_EQ(svg.find("boundary"), std::string::npos);
  EXPECT_EQ(svg.find("hidden"), std::string::npos);
}

TEST(Svg, IsInMillimetres) {
  const std::string svg = svg_text(one_of_each());
  EXPECT_NE(svg.find("width=\"35mm\" height=\"20mm\" viewBox=\"0 0 35 20\""), std::string::npos) << svg.substr(0, 400);
  EXPECT_NE(svg.find("<path d=\"M27.5 5.154l-5 12.346 10 0Z\"/>"), std::string::npos) << svg;
}

TEST(Svg, StrokesAreInProportionToTheSilhouettes) {
  SvgOptions options;
  options.stroke_mm = 0.3;
  const std::string svg = svg_text(one_of_each(), options);
  const auto width = [&](const std::string& layer) {
    const std::size_t at = svg.find("stroke-width=\"", svg.find("id=\"" + layer)) + 14;
    return svg.substr(at, svg.find('"', at) - at);
  };
  EXPECT_EQ(width("silhouette-visible"), "0.3");
  EXPECT_EQ(width("silhouette-hidden"), "0.15");
  EXPECT_EQ(width("boundary-visible"), "0.21");
  EXPECT_EQ(width("crease-hidden"), "0.075");
}

TEST(Svg, HoldsThePagesPointsExactly) {
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 6000});
  const Camera camera = fit_camera(mesh.positions, view_direction(0.3f, 0.3f));
  const Page page = *lay_out(outline_edges(mesh, camera), camera);
  const std::string svg = svg_text(page);
  EXPECT_EQ(xml_fault(svg), "");
  const auto paths = paths_of(svg, page.height_mm);
  ASSERT_EQ(paths.size(), page.strokes.size());
  for (std::size_t i = 0; i < paths.size(); ++i) {
    ASSERT_EQ(paths[i].size(), page.strokes[i].end - page.strokes[i].begin);
    for (std::size_t k = 0; k < paths[i].size(); ++k)
      EXPECT_LT(glm::distance(paths[i][k], page.points[page.strokes[i].begin + k]), 1e-8);
  }
}

TEST(Svg, WritesNumbersShortAndPlain) {
  const std::string svg = svg_text(one_of_each());
  const std::string data = svg.substr(svg.find("<g "));
  EXPECT_FALSE(std::regex_search(data, std::regex(R"(-0[^.]|\d[eE][-+\d]|\.\d{4}|\.\d*0[^\d.]|nan|inf)"))) << data;
}

TEST(Svg, StaysWellFormedWhateverTheTitle) {
  for (const std::string& title :
       {std::string("a<b>&\"c'"), std::string("knot\xff\xfe.ply"), std::string("\x01\x1b[31m\0x", 7),
        std::string("]]> --> <!--"), std::string("größe \xe6\x97\xa5 \xf0\x9f\x98\x80"),
        std::string("\xed\xa0\x80\xc0\x80"), std::string("\xef\xbf\xbf\xe2\x82")}) {
    SvgOptions options;
    options.title = title;
    options.description = title;
    const std::string svg = svg_text(one_of_each(), options);
    EXPECT_EQ(xml_fault(svg), "") << title;
    for (const char c : svg)
      EXPECT_FALSE(static_cast<unsigned char>(c) < 0x20 && c != '\n') << title;
  }
  SvgOptions options;
  options.title = "größe <1>";
  EXPECT_NE(svg_text(one_of_each(), options).find("<title>größe &lt;1&gt;</title>"), std::string::npos);
  options.title = "a\xff";
  EXPECT_NE(svg_text(one_of_each(), options).find("<title>a\xef\xbf\xbd</title>"), std::string::npos);
}

TEST(Svg, OfABlankPageIsADocument) {
  const std::string svg = svg_text(*lay_out({}, Camera{}));
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(svg.find("<path"), std::string::npos);
}

}  // namespace
}  // namespace limn::test
