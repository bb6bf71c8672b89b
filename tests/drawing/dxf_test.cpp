// DXF pages: every pair well formed, every reference resolved, layers and units as promised.
#include "limn/drawing/dxf.h"

#include <charconv>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "limn/mesh/shapes.h"

#include "drawing/lines.h"

namespace limn::test {
namespace {

struct Pair {
  int code = -1;
  std::string value;
};

/// The pairs of a DXF; fails the test where a line is not what the format demands.
std::vector<Pair> pairs_of(const std::string& dxf) {
  std::vector<Pair> pairs;
  std::istringstream lines(dxf);
  for (std::string code, value; std::getline(lines, code);) {
    EXPECT_TRUE(std::getline(lines, value)) << "a code without a value";
    const std::size_t begin = code.find_first_not_of(' ');
    Pair pair;
    if (begin != std::string::npos) {
      const auto read = std::from_chars(code.data() + begin, code.data() + code.size(), pair.code);
      EXPECT_EQ(read.ptr, code.data() + code.size()) << code;
    }
    EXPECT_GE(pair.code, 0) << code;
    EXPECT_LE(value.size(), 255u);
    pair.value = value;
    pairs.push_back(pair);
  }
  return pairs;
}

bool is_real(int code) {
  return (code >= 10 && code < 60) || (code >= 140 && code < 150);
}
bool is_integer(int code) {
  return (code >= 60 && code < 80) || (code >= 90 && code < 100) || (code >= 170 && code < 180) || code == 281;
}
bool is_handle(int code) {
  return code == 5 || code == 105 || code == 330 || code == 350;
}

/// One thing that begins with code 0, and what belongs to it.
struct Record {
  std::string type;
  std::string section;
  std::string table;
  std::vector<Pair> pairs;

  std::string value(int code) const {
    for (const Pair& pair : pairs) {
      if (pair.code == code) return pair.value;
    }
    return "";
  }
  std::vector<double> reals(int code) const {
    std::vector<double> found;
    for (const Pair& pair : pairs) {
      if (pair.code == code) found.push_back(std::stod(pair.value));
    }
    return found;
  }
};

void check_values(const std::vector<Pair>& pairs) {
  for (const Pair& pair : pairs) {
    const char* const end = pair.value.data() + pair.value.size();
    if (is_real(pair.code)) {
      double value = NAN;
      EXPECT_EQ(std::from_chars(pair.value.data(), end, value).ptr, end) << pair.code << " " << pair.value;
      EXPECT_TRUE(std::isfinite(value)) << pair.value;
      EXPECT_NE(pair.value.find('.'), std::string::npos) << pair.value;
      EXPECT_EQ(pair.value.find_first_not_of("-.0123456789"), std::string::npos) << pair.value;
    } else if (is_integer(pair.code)) {
      long long value = 0;
      EXPECT_EQ(std::from_chars(pair.value.data(), end, value).ptr, end) << pair.code << " " << pair.value;
    } else if (is_handle(pair.code)) {
      unsigned value = 0;
      EXPECT_EQ(std::from_chars(pair.value.data(), end, value, 16).ptr, end) << pair.code << " " << pair.value;
    }
  }
}

/// Checks the order of sections, tables, handles and owners, and gives the records.
std::vector<Record> read_strictly(const std::string& dxf) {
  const std::vector<Pair> pairs = pairs_of(dxf);
  check_values(pairs);
  std::vector<Record> records;
  std::vector<std::string> sections;
  std::string section, table;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].code != 0) {
      if (!records.empty()) records.back().pairs.push_back(pairs[i]);
      continue;
    }
    const std::string& type = pairs[i].value;
    if (type == "SECTION") {
      EXPECT_EQ(section, "");
      section = pairs.at(i + 1).value;
      sections.push_back(section);
    } else if (type == "TABLE") {
      EXPECT_EQ(table, "");
      table = pairs.at(i + 1).value;
    }
    records.push_back({type, section, table, {}});
    if (type == "ENDSEC") section.clear();
    if (type == "ENDTAB") table.clear();
  }
  EXPECT_EQ(sections, (std::vector<std::string>{"HEADER", "CLASSES", "TABLES", "BLOCKS", "ENTITIES", "OBJECTS"}));
  EXPECT_EQ(records.empty() ? "" : records.back().type, "EOF");
  return records;
}

void check_handles(const std::vector<Record>& records) {
  std::set<std::string> handles{"0"};
  for (const Record& record : records) {
    if (record.section == "HEADER") continue;
    const std::string handle = record.value(record.type == "DIMSTYLE" ? 105 : 5);
    const bool structure =
        record.type == "SECTION" || record.type == "ENDSEC" || record.type == "ENDTAB" || record.type == "EOF";
    EXPECT_EQ(handle.empty(), structure) << record.type;
    if (!handle.empty()) {
      EXPECT_TRUE(handles.insert(handle).second) << record.type << " repeats " << handle;
    }
  }
  std::string seed;
  for (const Record& record : records) {
    if (record.section == "HEADER" && record.type == "SECTION") seed = record.value(5);
    for (const Pair& pair : record.pairs) {
      if (pair.code == 330 || pair.code == 350) {
        EXPECT_TRUE(handles.contains(pair.value)) << pair.value;
      }
    }
  }
  for (const std::string& handle : handles)
    EXPECT_LT(std::stoul(handle, nullptr, 16), std::stoul(seed, nullptr, 16));
}

void check_names(const std::vector<Record>& records) {
  std::map<std::string, std::set<std::string>> names;
  std::map<std::string, std::size_t> counts;
  std::map<std::string, std::string> promised;
  for (const Record& record : records) {
    if (record.type == "TABLE") promised[record.table] = record.value(70);
    if (record.section != "TABLES" || record.type != record.table) continue;
    ++counts[record.table];
    EXPECT_TRUE(names[record.table].insert(record.value(2)).second) << record.value(2);
  }
  for (const auto& [table, count] : promised)
    EXPECT_EQ(std::to_string(counts[table]), count) << table;
  for (const char* table : {"VPORT", "LTYPE", "LAYER", "STYLE", "VIEW", "UCS", "APPID", "DIMSTYLE", "BLOCK_RECORD"})
    EXPECT_TRUE(promised.contains(table)) << table;
  for (const Record& record : records) {
    if (record.type == "LAYER") {
      EXPECT_TRUE(names["LTYPE"].contains(record.value(6))) << record.value(6);
    }
    if (record.section == "ENTITIES" && record.type == "LWPOLYLINE") {
      EXPECT_TRUE(names["LAYER"].contains(record.value(8))) << record.value(8);
    }
    if (record.type == "BLOCK") {
      EXPECT_TRUE(names["BLOCK_RECORD"].contains(record.value(2))) << record.value(2);
    }
  }
}

std::string header_value(const std::vector<Record>& records, const std::string& variable) {
  for (const Record& record : records) {
    for (std::size_t i = 0; i + 1 < record.pairs.size(); ++i) {
      if (record.pairs[i].code == 9 && record.pairs[i].value == variable) return record.pairs[i + 1].value;
    }
  }
  return "";
}

void expect_dxf_of(const Page& page) {
  const std::vector<Record> records = read_strictly(dxf_text(page));
  check_handles(records);
  check_names(records);
  std::size_t stroke = 0;
  for (const Record& record : records) {
    if (record.type != "LWPOLYLINE") continue;
    ASSERT_LT(stroke, page.strokes.size());
    const Stroke& drawn = page.strokes[stroke++];
    EXPECT_EQ(record.value(8), layer_name(drawn.layer));
    EXPECT_EQ(record.value(70), drawn.closed ? "1" : "0");
    EXPECT_EQ(record.value(90), std::to_string(drawn.end - drawn.begin));
    const std::vector<double> x = record.reals(10);
    const std::vector<double> y = record.reals(20);
    ASSERT_EQ(x.size(), drawn.end - drawn.begin);
    ASSERT_EQ(y.size(), x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(x[i], page.points[drawn.begin + i].x, 1e-9);
      EXPECT_NEAR(y[i], page.points[drawn.begin + i].y, 1e-9);
    }
  }
  EXPECT_EQ(stroke, page.strokes.size());
}

Page all_layers() {
  Polylines lines;
  float y = 0;
  for (const LineClass line_class : kLineClasses) {
    for (const bool visible : {true, false}) {
      add_line(lines, {{0, y, 0}, {10, y, 0}, {10.5f, y + 1, 0}}, line_class, visible, y == 4);
      y += 2;
    }
  }
  return *lay_out(lines, from_above());
}

TEST(Dxf, HoldsEveryStrokeInItsLayer) {
  expect_dxf_of(all_layers());
}

TEST(Dxf, OfAModelHoldsEveryStroke) {
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 3000});
  const Camera camera = fit_camera(mesh.positions, view_direction(0.3f, 0.3f));
  expect_dxf_of(*lay_out(outline_edges(mesh, camera), camera));
}

TEST(Dxf, OfABlankPageIsADrawing) {
  expect_dxf_of(*lay_out({}, Camera{}));
}

TEST(Dxf, SaysThatItsUnitsAreMillimetresAndHowLargeThePageIs) {
  const Page page = all_layers();
  const std::vector<Record> records = read_strictly(dxf_text(page));
  EXPECT_EQ(header_value(records, "$ACADVER"), "AC1015");
  EXPECT_EQ(header_value(records, "$INSUNITS"), "4");
  EXPECT_EQ(header_value(records, "$MEASUREMENT"), "1");
  EXPECT_EQ(std::stod(header_value(records, "$EXTMAX")), page.width_mm);
}

TEST(Dxf, DashesHiddenLayersOnly) {
  const std::vector<Record> records = read_strictly(dxf_text(all_layers()));
  int layers = 0;
  for (const Record& record : records) {
    if (record.type == "LTYPE" && record.value(2) == "DASHED") {
      EXPECT_EQ(record.reals(49), (std::vector<double>{2, -1}));
    }
    if (record.type != "LAYER" || record.value(2) == "0") continue;
    ++layers;
    EXPECT_EQ(record.value(6), record.value(2).ends_with("-hidden") ? "DASHED" : "CONTINUOUS");
  }
  EXPECT_EQ(layers, 8);
}

}  // namespace
}  // namespace limn::test
