#include "limn/drawing/edge_list.h"

#include "limn/drawing/layer.h"
#include "limn/mesh/formats/text.h"

namespace limn {
namespace {

using formats::append_number;

void append_edge(std::string& text, const DrawnEdge& drawn, const Edge& edge) {
  text += "{\"v\":[";
  append_number(text, std::uint64_t{edge.v[0]});
  text += ',';
  append_number(text, std::uint64_t{edge.v[1]});
  text += "],\"class\":\"";
  text += line_class_name(drawn.line_class);
  text += drawn.visible.empty() ? "\",\"visible\":false" : "\",\"visible\":true";
  if (drawn.hidden && !drawn.visible.empty()) {
    text += ",\"visible_parts\":[";
    for (const EdgePart& part : drawn.visible) {
      text += &part == drawn.visible.data() ? "[" : ",[";
      append_number(text, part.from);
      text += ',';
      append_number(text, part.to);
      text += ']';
    }
    text += ']';
  }
  text += drawn.outer ? ",\"outer\":true}" : "}";
}

}  // namespace

std::vector<DrawnEdge> drawn_edges(std::span<const EdgeInterval> intervals) {
  std::vector<DrawnEdge> edges;
  for (const EdgeInterval& interval : intervals) {
    if (edges.empty() || edges.back().edge != interval.edge) {
      edges.push_back({interval.edge, interval.line_class, false, false, {}});
    }
    DrawnEdge& drawn = edges.back();
    drawn.outer = drawn.outer || interval.outer;
    drawn.hidden = drawn.hidden || !interval.visible;
    if (!interval.visible) continue;
    if (!drawn.visible.empty() && drawn.visible.back().to == interval.begin) {
      drawn.visible.back().to = interval.end;
    } else {
      drawn.visible.push_back({interval.begin, interval.end});
    }
  }
  return edges;
}

std::string edges_json(const std::vector<DrawnEdge>& edges, const Topology& topology) {
  std::string text = "[";
  text.reserve(64 * edges.size() + 4);
  for (const DrawnEdge& drawn : edges) {
    text += &drawn == edges.data() ? "\n" : ",\n";
    append_edge(text, drawn, topology.edges[drawn.edge]);
  }
  return text + (edges.empty() ? "]" : "\n]");
}

}  // namespace limn
