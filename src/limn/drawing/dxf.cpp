#include "limn/drawing/dxf.h"

#include <cstdint>
#include <fmt/format.h>
#include <string_view>
#include <vector>

#include "limn/drawing/number.h"

namespace limn {
namespace {

/// Handles of what every drawing holds; strokes count on from kFirstFree.
enum Handle : std::uint32_t {
  kLinetypes = 0x1,
  kLayers,
  kStyles,
  kViewports,
  kViews,
  kCoordinateSystems,
  kApplications,
  kDimensionStyles,
  kBlockRecords,
  kModelRecord,
  kPaperRecord,
  kModelBlock,
  kModelBlockEnd,
  kPaperBlock,
  kPaperBlockEnd,
  kByBlock,
  kByLayer,
  kContinuous,
  kDashed,
  kStandardStyle,
  kActiveViewport,
  kAcad,
  kStandardDimensions,
  kRootDictionary,
  kGroupDictionary,
  kFirstLayer,
  kFirstFree = kFirstLayer + 1 + static_cast<std::uint32_t>(kLayerCount),
};

/// Writes a DXF's pairs: a group code on one line, its value on the next.
class Pairs {
 public:
  void put(int code, std::string_view value) {
    text += fmt::format("{:3}\n", code);
    text += value;
    text += '\n';
  }
  void put_integer(int code, std::int64_t value) { put(code, fmt::format("{}", value)); }
  void put_handle(int code, std::uint32_t handle) { put(code, fmt::format("{:X}", handle)); }
  void put_mm(int code, double mm) {
    text += fmt::format("{:3}\n", code);
    const std::size_t begin = text.size();
    drawing::append_mm(text, mm);
    // Some readers tell real numbers by their point.
    text += text.find('.', begin) == std::string::npos ? ".0\n" : "\n";
  }
  void put_point(int code, double x, double y) {
    put_mm(code, x);
    put_mm(code + 10, y);
  }

  void begin_section(std::string_view name) {
    put(0, "SECTION");
    put(2, name);
  }
  void end_section() { put(0, "ENDSEC"); }

  void begin_table(std::string_view name, Handle handle, int count) {
    put(0, "TABLE");
    put(2, name);
    put_handle(5, handle);
    put_handle(330, 0);
    put(100, "AcDbSymbolTable");
    put_integer(70, count);
  }
  void end_table() { put(0, "ENDTAB"); }

  /// What every entry of a table begins with.
  void begin_record(std::string_view type, std::uint32_t handle, Handle owner, std::string_view subclass) {
    put(0, type);
    put_handle(type == "DIMSTYLE" ? 105 : 5, handle);
    put_handle(330, owner);
    put(100, "AcDbSymbolTableRecord");
    put(100, subclass);
  }

  std::string text;
};

/// The layers that hold strokes.
std::vector<Layer> used_layers(const Page& page) {
  std::vector<Layer> used;
  for (std::size_t number = 0; number < kLayerCount; ++number) {
    const auto layer = static_cast<Layer>(number);
    for (const Stroke& stroke : page.strokes) {
      if (stroke.layer != layer) continue;
      used.push_back(layer);
      break;
    }
  }
  return used;
}

void put_header(Pairs& pairs, const Page& page) {
  const auto variable = [&](std::string_view name) { pairs.put(9, name); };
  pairs.begin_section("HEADER");
  variable("$ACADVER");
  pairs.put(1, "AC1015");
  variable("$DWGCODEPAGE");
  pairs.put(3, "ANSI_1252");
  variable("$INSBASE");
  pairs.put_point(10, 0, 0);
  pairs.put_mm(30, 0);
  variable("$EXTMIN");
  pairs.put_point(10, 0, 0);
  pairs.put_mm(30, 0);
  variable("$EXTMAX");
  pairs.put_point(10, page.width_mm, page.height_mm);
  pairs.put_mm(30, 0);
  variable("$LIMMIN");
  pairs.put_point(10, 0, 0);
  variable("$LIMMAX");
  pairs.put_point(10, page.width_mm, page.height_mm);
  variable("$LTSCALE");
  pairs.put_mm(40, 1);
  variable("$MEASUREMENT");
  pairs.put_integer(70, 1);
  variable("$INSUNITS");
  pairs.put_integer(70, 4);
  variable("$HANDSEED");
  pairs.put_handle(5, kFirstFree + static_cast<std::uint32_t>(page.strokes.size()));
  pairs.end_section();
  pairs.begin_section("CLASSES");
  pairs.end_section();
}

void put_viewport(Pairs& pairs, const Page& page) {
  pairs.begin_table("VPORT", kViewports, 1);
  pairs.begin_record("VPORT", kActiveViewport, kViewports, "AcDbViewportTableRecord");
  pairs.put(2, "*ACTIVE");
  pairs.put_integer(70, 0);
  pairs.put_point(10, 0, 0);
  pairs.put_point(11, 1, 1);
  pairs.put_point(12, 0.5 * page.width_mm, 0.5 * page.height_mm);
  pairs.put_point(13, 0, 0);
  pairs.put_point(14, 10, 10);
  pairs.put_point(15, 10, 10);
  pairs.put_point(16, 0, 0);
  pairs.put_mm(36, 1);
  pairs.put_point(17, 0, 0);
  pairs.put_mm(37, 0);
  pairs.put_mm(40, page.height_mm > 0.0 ? page.height_mm : 1.0);
  pairs.put_mm(41, page.height_mm > 0.0 && page.width_mm > 0.0 ? page.width_mm / page.height_mm : 1.0);
  pairs.put_mm(42, 50);
  pairs.end_table();
}

void put_linetype(Pairs& pairs, Handle handle, std::string_view name, std::string_view what,
                  const std::vector<double>& dashes_mm) {
  pairs.begin_record("LTYPE", handle, kLinetypes, "AcDbLinetypeTableRecord");
  pairs.put(2, name);
  pairs.put_integer(70, 0);
  pairs.put(3, what);
  pairs.put_integer(72, 65);
  pairs.put_integer(73, static_cast<std::int64_t>(dashes_mm.size()));
  double length = 0.0;
  for (const double dash : dashes_mm)
    length += dash < 0.0 ? -dash : dash;
  pairs.put_mm(40, length);
  for (const double dash : dashes_mm) {
    pairs.put_mm(49, dash);
    pairs.put_integer(74, 0);
  }
}

void put_linetypes(Pairs& pairs) {
  pairs.begin_table("LTYPE", kLinetypes, 4);
  put_linetype(pairs, kByBlock, "BYBLOCK", "", {});
  put_linetype(pairs, kByLayer, "BYLAYER", "", {});
  put_linetype(pairs, kContinuous, "CONTINUOUS", "Solid line", {});
  put_linetype(pairs, kDashed, "DASHED", "Hidden lines __ __ __", {2.0, -1.0});
  pairs.end_table();
}

void put_layer(Pairs& pairs, std::uint32_t handle, std::string_view name, std::string_view linetype) {
  constexpr int kBlackOrWhite = 7;
  pairs.begin_record("LAYER", handle, kLayers, "AcDbLayerTableRecord");
  pairs.put(2, name);
  pairs.put_integer(70, 0);
  pairs.put_integer(62, kBlackOrWhite);
  pairs.put(6, linetype);
}

void put_layers(Pairs& pairs, const std::vector<Layer>& used) {
  pairs.begin_table("LAYER", kLayers, static_cast<int>(used.size()) + 1);
  put_layer(pairs, kFirstLayer, "0", "CONTINUOUS");
  for (std::size_t i = 0; i < used.size(); ++i) {
    put_layer(pairs, kFirstLayer + 1 + static_cast<std::uint32_t>(i), layer_name(used[i]),
              is_visible(used[i]) ? "CONTINUOUS" : "DASHED");
  }
  pairs.end_table();
}

void put_style(Pairs& pairs) {
  pairs.begin_table("STYLE", kStyles, 1);
  pairs.begin_record("STYLE", kStandardStyle, kStyles, "AcDbTextStyleTableRecord");
  pairs.put(2, "STANDARD");
  pairs.put_integer(70, 0);
  pairs.put_mm(40, 0);
  pairs.put_mm(41, 1);
  pairs.put_mm(50, 0);
  pairs.put_integer(71, 0);
  pairs.put_mm(42, 2.5);
  pairs.put(3, "txt");
  pairs.put(4, "");
  pairs.end_table();
}

void put_applications(Pairs& pairs) {
  pairs.begin_table("APPID", kApplications, 1);
  pairs.begin_record("APPID", kAcad, kApplications, "AcDbRegAppTableRecord");
  pairs.put(2, "ACAD");
  pairs.put_integer(70, 0);
  pairs.end_table();
}

void put_dimension_styles(Pairs& pairs) {
  pairs.begin_table("DIMSTYLE", kDimensionStyles, 1);
  pairs.put(100, "AcDbDimStyleTable");
  pairs.put_integer(71, 0);
  pairs.begin_record("DIMSTYLE", kStandardDimensions, kDimensionStyles, "AcDbDimStyleTableRecord");
  pairs.put(2, "STANDARD");
  pairs.put_integer(70, 0);
  pairs.end_table();
}

void put_block_records(Pairs& pairs) {
  pairs.begin_table("BLOCK_RECORD", kBlockRecords, 2);
  pairs.begin_record("BLOCK_RECORD", kModelRecord, kBlockRecords, "AcDbBlockTableRecord");
  pairs.put(2, "*Model_Space");
  pairs.begin_record("BLOCK_RECORD", kPaperRecord, kBlockRecords, "AcDbBlockTableRecord");
  pairs.put(2, "*Paper_Space");
  pairs.end_table();
}

void put_tables(Pairs& pairs, const Page& page) {
  pairs.begin_section("TABLES");
  put_viewport(pairs, page);
  put_linetypes(pairs);
  put_layers(pairs, used_layers(page));
  put_style(pairs);
  pairs.begin_table("VIEW", kViews, 0);
  pairs.end_table();
  pairs.begin_table("UCS", kCoordinateSystems, 0);
  pairs.end_table();
  put_applications(pairs);
  put_dimension_styles(pairs);
  put_block_records(pairs);
  pairs.end_section();
}

void put_block(Pairs& pairs, std::string_view name, Handle record, Handle begin, Handle end, bool paper) {
  const auto common = [&](std::string_view type, Handle handle, std::string_view subclass) {
    pairs.put(0, type);
    pairs.put_handle(5, handle);
    pairs.put_handle(330, record);
    pairs.put(100, "AcDbEntity");
    if (paper) pairs.put_integer(67, 1);
    pairs.put(8, "0");
    pairs.put(100, subclass);
  };
  common("BLOCK", begin, "AcDbBlockBegin");
  pairs.put(2, name);
  pairs.put_integer(70, 0);
  pairs.put_point(10, 0, 0);
  pairs.put_mm(30, 0);
  pairs.put(3, name);
  pairs.put(1, "");
  common("ENDBLK", end, "AcDbBlockEnd");
}

void put_stroke(Pairs& pairs, const Page& page, const Stroke& stroke, std::uint32_t handle) {
  pairs.put(0, "LWPOLYLINE");
  pairs.put_handle(5, handle);
  pairs.put_handle(330, kModelRecord);
  pairs.put(100, "AcDbEntity");
  pairs.put(8, layer_name(stroke.layer));
  pairs.put(100, "AcDbPolyline");
  pairs.put_integer(90, stroke.end - stroke.begin);
  pairs.put_integer(70, stroke.closed ? 1 : 0);
  for (std::uint32_t i = stroke.begin; i < stroke.end; ++i)
    pairs.put_point(10, page.points[i].x, page.points[i].y);
}

void put_objects(Pairs& pairs) {
  pairs.begin_section("OBJECTS");
  pairs.put(0, "DICTIONARY");
  pairs.put_handle(5, kRootDictionary);
  pairs.put_handle(330, 0);
  pairs.put(100, "AcDbDictionary");
  pairs.put_integer(281, 1);
  pairs.put(3, "ACAD_GROUP");
  pairs.put_handle(350, kGroupDictionary);
  pairs.put(0, "DICTIONARY");
  pairs.put_handle(5, kGroupDictionary);
  pairs.put_handle(330, kRootDictionary);
  pairs.put(100, "AcDbDictionary");
  pairs.put_integer(281, 1);
  pairs.end_section();
}

}  // namespace

std::string dxf_text(const Page& page) {
  Pairs pairs;
  pairs.text.reserve(8000 + 24 * page.points.size() + 160 * page.strokes.size());
  put_header(pairs, page);
  put_tables(pairs, page);
  pairs.begin_section("BLOCKS");
  put_block(pairs, "*Model_Space", kModelRecord, kModelBlock, kModelBlockEnd, false);
  put_block(pairs, "*Paper_Space", kPaperRecord, kPaperBlock, kPaperBlockEnd, true);
  pairs.end_section();
  pairs.begin_section("ENTITIES");
  for (std::size_t i = 0; i < page.strokes.size(); ++i)
    put_stroke(pairs, page, page.strokes[i], kFirstFree + static_cast<std::uint32_t>(i));
  pairs.end_section();
  put_objects(pairs);
  pairs.put(0, "EOF");
  return std::move(pairs.text);
}

}  // namespace limn
