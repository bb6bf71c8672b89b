#include "limn/drawing/svg.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "limn/drawing/number.h"

namespace limn {
namespace {

using drawing::append_mm;
using drawing::mm_text;

/// How many bytes the UTF-8 sequence at the start of a text has; 0 when it is none, or of a character XML forbids.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xc0u) == 0x80u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 || lead == '\t' || lead == '\n' ? (lead == 0x7f ? 0 : 1) : 0;
  if (lead >= 0xc2 && lead < 0xe0) return follows(1) ? 2 : 0;
  if (lead >= 0xe0 && lead < 0xf0) {
    if (!follows(1) || !follows(2)) return 0;
    const unsigned code = (lead & 0x0fu) << 12 | (byte(1) & 0x3fu) << 6 | (byte(2) & 0x3fu);
    return code >= 0x800 && !(code >= 0xd800 && code < 0xe000) && code < 0xfffe ? 3 : 0;
  }
  if (lead >= 0xf0 && lead < 0xf5) {
    if (!follows(1) || !follows(2) || !follows(3)) return 0;
    const unsigned code = (lead & 7u) << 18 | (byte(1) & 0x3fu) << 12;
    return code >= 0x10000 && code < 0x110000 ? 4 : 0;
  }
  return 0;
}

/// Text as XML can hold it.
std::string escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) {
      out += "\xef\xbf\xbd";  // the replacement character
    } else if (text[0] == '&') {
      out += "&amp;";
    } else if (text[0] == '<') {
      out += "&lt;";
    } else if (text[0] == '>') {
      out += "&gt;";
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

/// Inkscape's label: "silhouette hidden".
std::string label_of(Layer layer) {
  return fmt::format("{} {}", line_class_name(class_of(layer)), is_visible(layer) ? "visible" : "hidden");
}

/// Rounded to a step, and no thinner than one.
double stroke_width(Layer layer, double stroke_mm) {
  return std::max(kPageStepMm, std::round(stroke_mm * stroke_factor(layer) / kPageStepMm) * kPageStepMm);
}

void append_group_start(std::string& text, Layer layer, const SvgOptions& options) {
  const double width = stroke_width(layer, options.stroke_mm);
  text += fmt::format(R"(<g id="{}" inkscape:groupmode="layer" inkscape:label="{}" stroke-width="{}")",
                      layer_name(layer), label_of(layer), mm_text(width));
  if (!is_visible(layer)) {
    text +=
        fmt::format(R"( stroke-dasharray="{} {}" stroke-linecap="butt")", mm_text(8.0 * width), mm_text(4.0 * width));
  }
  text += ">\n";
}

/// One path: its first point, then steps from point to point. Coordinates lie on the page's steps, so that none drifts.
void append_path(std::string& text, const Page& page, const Stroke& stroke) {
  const auto point = [&](std::uint32_t i) { return glm::dvec2(page.points[i].x, page.height_mm - page.points[i].y); };
  const auto append_pair = [&text](const glm::dvec2& v) {
    append_mm(text, v.x);
    text += ' ';
    append_mm(text, v.y);
  };
  text += "<path d=\"M";
  append_pair(point(stroke.begin));
  for (std::uint32_t i = stroke.begin + 1; i < stroke.end; ++i) {
    text += i == stroke.begin + 1 ? 'l' : ' ';
    append_pair(point(i) - point(i - 1));
  }
  text += stroke.closed ? "Z\"/>\n" : "\"/>\n";
}

}  // namespace

std::string svg_text(const Page& page, const SvgOptions& options) {
  const std::string width = mm_text(page.width_mm);
  const std::string height = mm_text(page.height_mm);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  text += fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" version="1.1" )"
      R"(width="{0}mm" height="{1}mm" viewBox="0 0 {0} {1}" fill="none" stroke="#000000" stroke-linecap="round" )"
      "stroke-linejoin=\"round\">\n",
      width, height);
  if (!options.title.empty()) text += fmt::format("<title>{}</title>\n", escaped(options.title));
  if (!options.description.empty()) text += fmt::format("<desc>{}</desc>\n", escaped(options.description));
  text.reserve(text.size() + 14 * page.points.size() + 24 * page.strokes.size() + 2000);
  for (std::size_t number = kLayerCount; number-- > 0;) {
    const auto layer = static_cast<Layer>(number);
    bool begun = false;
    for (const Stroke& stroke : page.strokes) {
      if (stroke.layer != layer) continue;
      if (!begun) append_group_start(text, layer, options);
      begun = true;
      append_path(text, page, stroke);
    }
    if (begun) text += "</g>\n";
  }
  return text + "</svg>\n";
}

}  // namespace limn
