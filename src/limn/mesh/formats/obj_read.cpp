#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/obj_material.h"
#include "limn/mesh/formats/parse_number.h"
#include "limn/mesh/formats/polygon.h"

namespace limn::formats {
namespace {

/// The largest index that is not kInvalidId; more elements than that cannot be told apart.
constexpr std::uint64_t kMostElements = kInvalidId;
constexpr std::size_t kLinesBetweenReports = std::size_t{1} << 16;

/// One of the three lists a face's corner points into.
struct IndexedList {
  const char* what;                    ///< for messages
  std::vector<std::uint32_t> corners;  ///< one a corner; kInvalidId where the corner names none; may end early
  std::uint64_t largest = 0;           ///< the largest index (from 1) named before it was defined, and by whom
  std::size_t line = 0;
  std::size_t face = 0;
};

bool names_any(const IndexedList& list) {
  return std::any_of(list.corners.begin(), list.corners.end(), [](std::uint32_t index) { return index != kInvalidId; });
}

/// Reads the text once, front to back, with plain pointers; what it finds wrong is kept in error_.
class ObjReader {
 public:
  explicit ObjReader(const Source& source)
      : source_(source), at_(reinterpret_cast<const char*>(source.bytes.data())), end_(at_ + source.bytes.size()) {}

  Result<ImportedMesh> read();

 private:
  bool fail(std::string message, std::string remedy = {}, ErrorCode code = ErrorCode::kUnreadable);
  bool fail_at_line(std::size_t line, std::string message, std::string remedy = {},
                    ErrorCode code = ErrorCode::kUnreadable);

  bool read_lines();
  bool statement();
  bool vertex();
  bool normal();
  bool uv();
  bool face();
  bool corner();
  bool index(IndexedList& list, std::size_t number, std::size_t defined);
  std::string this_face() const { return "face " + std::to_string(face_count_ + 1); }
  bool take_index(std::int64_t& value);
  bool numbers(float* values, std::size_t least, std::size_t most, std::size_t& count, const char* what);
  bool check_forward(const IndexedList& list, std::size_t defined);

  void skip_blanks();
  bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '\r' || *at_ == '#'; }
  void next_line();
  std::string_view word();
  std::string_view rest_of_line();

  bool finish();
  void cut_polygons();
  template <class T>
  void build(CornerAttribute<T>& attribute, IndexedList& list, std::vector<T>& values);
  void fill_missing_normals();
  void fill_missing_uvs();
  void build_materials();
  void write_notes();

  const Source& source_;
  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
  std::optional<Error> error_;

  std::vector<Vec3> normals_;
  std::vector<Vec2> uvs_;
  IndexedList position_refs_{"vertex", {}, 0, 0, 0};
  IndexedList uv_refs_{"texture coordinate", {}, 0, 0, 0};
  IndexedList normal_refs_{"normal", {}, 0, 0, 0};
  bool all_triangles_ = true;
  std::vector<std::uint32_t> face_sizes_;  ///< only while !all_triangles_
  std::size_t face_count_ = 0;
  bool any_uv_ = false;
  bool any_normal_ = false;

  std::vector<std::string> libraries_;
  std::vector<std::string> material_names_;
  std::map<std::string, std::uint32_t, std::less<>> material_index_;
  std::vector<std::pair<std::size_t, std::uint32_t>> material_runs_;  ///< first face, index into material_names_
  std::set<std::string, std::less<>> groups_;

  bool any_statement_ = false;
  std::size_t polygons_ = 0;
  std::size_t colored_ = 0;
  std::size_t weighted_ = 0;
  std::size_t points_and_lines_ = 0;
  std::size_t short_faces_ = 0;
  std::size_t free_form_ = 0;
  std::size_t unknown_ = 0;
  std::size_t first_unknown_line_ = 0;
  std::string first_unknown_;
  bool smoothing_ = false;
  std::vector<std::uint32_t> face_of_triangle_;  ///< the file's face; only while !all_triangles_
  ImportedMesh result_;
};

bool ObjReader::fail_at_line(std::size_t line, std::string message, std::string remedy, ErrorCode code) {
  if (!error_)
    error_ = Error{code, std::move(message), source_.name, "line " + std::to_string(line), std::move(remedy)};
  return false;
}

bool ObjReader::fail(std::string message, std::string remedy, ErrorCode code) {
  return fail_at_line(line_, std::move(message), std::move(remedy), code);
}

/// A backslash at the end of a line continues it.
void ObjReader::skip_blanks() {
  while (at_ != end_) {
    if (*at_ == ' ' || *at_ == '\t') {
      ++at_;
      continue;
    }
    if (*at_ != '\\') return;
    const char* next = at_ + 1;
    if (next != end_ && *next == '\r') ++next;
    if (next != end_ && *next == '\n') ++next;
    if (next == at_ + 1) return;
    at_ = next;
    ++line_;
  }
}

void ObjReader::next_line() {
  while (at_ != end_ && *at_ != '\n' && *at_ != '\r')
    ++at_;
  if (at_ != end_ && *at_ == '\r') ++at_;
  if (at_ != end_ && at_[0] == '\n') ++at_;
  ++line_;
}

std::string_view ObjReader::word() {
  const char* const begin = at_;
  while (at_ != end_ && *at_ != ' ' && *at_ != '\t' && *at_ != '\n' && *at_ != '\r')
    ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::string_view ObjReader::rest_of_line() {
  skip_blanks();
  const char* const begin = at_;
  while (at_ != end_ && *at_ != '\n' && *at_ != '\r')
    ++at_;
  std::string_view text(begin, static_cast<std::size_t>(at_ - begin));
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
    text.remove_suffix(1);
  return text;
}

bool ObjReader::numbers(float* values, std::size_t least, std::size_t most, std::size_t& count, const char* what) {
  count = 0;
  for (;;) {
    skip_blanks();
    if (at_line_end()) break;
    if (count == most) return fail(std::string(what) + " has more than " + std::to_string(most) + " numbers");
    const std::size_t used = parse_float({at_, static_cast<std::size_t>(end_ - at_)}, values[count]);
    const char* const after = at_ + used;
    const bool ended =
        after == end_ || *after == ' ' || *after == '\t' || *after == '\n' || *after == '\r' || *after == '\\';
    if (used == 0 || !ended)
      return fail(std::string(what) + ": \"" + std::string(word().substr(0, 40)) + "\" is not a number");
    at_ = after;
    ++count;
  }
  if (count < least) {
    return fail(std::string(what) + " has " + std::to_string(count) + " numbers, needs " + std::to_string(least),
                "the file may be truncated");
  }
  return true;
}

bool ObjReader::vertex() {
  float v[8];
  std::size_t count = 0;
  if (!numbers(v, 3, 8, count, "vertex")) return false;
  const Vec3 position(v[0], v[1], v[2]);
  std::vector<Vec3>& positions = result_.mesh.positions;
  if (!is_finite(position)) {
    return fail("vertex " + std::to_string(positions.size() + 1) + " has a coordinate that is not finite",
                "repair the model where it was made", ErrorCode::kUnsuitable);
  }
  if (positions.size() == kMostElements) return fail("more than 2^32 - 1 vertices");
  std::vector<Vec4>& colors = result_.mesh.colors.values;
  if (count >= 6) {
    const Vec4 color(v[3], v[4], v[5], count == 7 ? v[6] : 1.0f);
    if (!is_finite(Vec3(color)) || !std::isfinite(color.a)) {
      return fail("vertex " + std::to_string(positions.size() + 1) + " has a colour that is not finite",
                  "repair the model where it was made", ErrorCode::kUnsuitable);
    }
    colors.resize(positions.size(), Vec4(1.0f));
    colors.push_back(color);
    ++colored_;
  }
  if ((count == 4 || count == 5) && v[3] != 1.0f) ++weighted_;
  positions.push_back(position);
  return true;
}

bool ObjReader::normal() {
  float v[3];
  std::size_t count = 0;
  if (!numbers(v, 3, 3, count, "normal")) return false;
  const Vec3 n(v[0], v[1], v[2]);
  normals_.push_back(is_finite(n) ? n : Vec3(0.0f));
  return true;
}

bool ObjReader::uv() {
  float v[3] = {};
  std::size_t count = 0;
  if (!numbers(v, 1, 3, count, "texture coordinate")) return false;
  if (!std::isfinite(v[0]) || !std::isfinite(v[1])) {
    return fail("texture coordinate " + std::to_string(uvs_.size() + 1) + " is not finite",
                "repair the model where it was made", ErrorCode::kUnsuitable);
  }
  uvs_.emplace_back(v[0], v[1]);
  return true;
}

bool ObjReader::take_index(std::int64_t& value) {
  const bool negative = at_ != end_ && *at_ == '-';
  if (negative || (at_ != end_ && *at_ == '+')) ++at_;
  const char* const digits = at_;
  value = 0;
  while (at_ != end_ && *at_ >= '0' && *at_ <= '9') {
    if (at_ - digits > 15) return false;
    value = 10 * value + (*at_++ - '0');
  }
  if (at_ == digits) return false;
  if (negative) value = -value;
  return true;
}

/// Reads one index of the corner `number`, counts it from 0 and stores it; it may be left out ("1//3").
bool ObjReader::index(IndexedList& list, std::size_t number, std::size_t defined) {
  if (at_line_end() || *at_ == '/' || *at_ == ' ' || *at_ == '\t') return true;
  std::int64_t value = 0;
  if (!take_index(value)) return fail(this_face() + " has a malformed " + list.what + " index");
  if (value < 0) value += static_cast<std::int64_t>(defined) + 1;
  if (value <= 0 || static_cast<std::uint64_t>(value) > kMostElements) {
    return fail(
        this_face() + " names a " + list.what + " index out of range (" + std::to_string(defined) + " defined so far)",
        "indices count from 1, or back from -1");
  }
  const auto from_one = static_cast<std::uint64_t>(value);
  if (from_one > defined && from_one > list.largest) {
    list.largest = from_one;
    list.line = line_;
    list.face = face_count_ + 1;
  }
  if (list.corners.size() < number) list.corners.resize(number, kInvalidId);
  list.corners.push_back(static_cast<std::uint32_t>(from_one - 1));
  return true;
}

/// "v", "v/vt", "v//vn" or "v/vt/vn".
bool ObjReader::corner() {
  const std::size_t number = position_refs_.corners.size();
  if (!index(position_refs_, number, result_.mesh.positions.size())) return false;
  if (position_refs_.corners.size() == number) return fail(this_face() + " has a corner without a vertex index");
  for (IndexedList* list : {&uv_refs_, &normal_refs_}) {
    if (at_ == end_ || *at_ != '/') break;
    ++at_;
    if (!index(*list, number, list == &uv_refs_ ? uvs_.size() : normals_.size())) return false;
  }
  if (at_line_end() || *at_ == ' ' || *at_ == '\t' || *at_ == '\\') return true;
  return fail(this_face() + " has a malformed corner", "corners are written v, v/vt, v//vn or v/vt/vn");
}

bool ObjReader::face() {
  const std::size_t first = position_refs_.corners.size();
  for (;;) {
    skip_blanks();
    if (at_line_end()) break;
    if (!corner()) return false;
  }
  const std::size_t size = position_refs_.corners.size() - first;
  if (position_refs_.corners.size() >= kMostElements) return fail("more than 2^32 - 1 face corners");
  if (size < 3) {
    for (IndexedList* list : {&position_refs_, &uv_refs_, &normal_refs_}) {
      if (list->corners.size() > first) list->corners.resize(first);
    }
    ++short_faces_;
    return true;
  }
  if (size != 3) ++polygons_;
  if (size != 3 && all_triangles_) {
    all_triangles_ = false;
    face_sizes_.assign(face_count_, 3);
  }
  if (!all_triangles_) face_sizes_.push_back(static_cast<std::uint32_t>(size));
  ++face_count_;
  return true;
}

bool ObjReader::statement() {
  skip_blanks();
  if (at_line_end()) return true;
  const std::string_view key = word();
  bool known = true;
  bool good = true;
  if (key == "v") {
    good = vertex();
  } else if (key == "vn") {
    good = normal();
  } else if (key == "vt") {
    good = uv();
  } else if (key == "f" || key == "fo") {
    good = face();
  } else if (key == "usemtl") {
    const std::string name(rest_of_line());
    const auto [entry, added] = material_index_.try_emplace(name, static_cast<std::uint32_t>(material_names_.size()));
    if (added) material_names_.push_back(name);
    material_runs_.emplace_back(face_count_, entry->second);
  } else if (key == "mtllib") {
    libraries_.emplace_back(rest_of_line());
  } else if (key == "o" || key == "g") {
    groups_.emplace(rest_of_line());
  } else if (key == "s") {
    const std::string_view group = rest_of_line();
    smoothing_ |= group != "off" && group != "0";
  } else if (key == "p" || key == "l") {
    ++points_and_lines_;
  } else if (key == "vp" || key == "cstype" || key == "deg" || key == "bmat" || key == "step" || key == "curv" ||
             key == "curv2" || key == "surf" || key == "parm" || key == "trim" || key == "hole" || key == "scrv" ||
             key == "sp" || key == "end" || key == "con") {
    ++free_form_;
  } else {
    known = false;
    if (unknown_++ == 0) {
      first_unknown_ = std::string(key.substr(0, 40));
      first_unknown_line_ = line_;
    }
  }
  any_statement_ |= known;
  return good;
}

bool ObjReader::read_lines() {
  const auto size = static_cast<double>(source_.bytes.size());
  const char* const begin = at_;
  if (source_.bytes.size() >= 3 && std::string_view(at_, 3) == "\xef\xbb\xbf") at_ += 3;
  while (at_ != end_) {
    if (!statement()) return false;
    next_line();
    if (line_ % kLinesBetweenReports == 0 &&
        !report(source_.progress, "reading", static_cast<double>(at_ - begin) / size)) {
      return fail("cancelled", {}, ErrorCode::kCancelled);
    }
  }
  return true;
}

bool ObjReader::check_forward(const IndexedList& list, std::size_t defined) {
  if (list.largest <= defined) return true;
  return fail_at_line(list.line,
                      "face " + std::to_string(list.face) + " names " + list.what + " " + std::to_string(list.largest) +
                          ", but the file has " + std::to_string(defined),
                      "the file may be truncated");
}

/// Cuts polygons into triangles; uv and normal indices go with their corners.
void ObjReader::cut_polygons() {
  std::vector<std::array<std::uint32_t, 3>> local;
  std::vector<Vec3> points;
  IndexedList* const lists[] = {&position_refs_, &uv_refs_, &normal_refs_};
  std::vector<std::uint32_t> cut[3];
  std::size_t first = 0;
  for (std::size_t f = 0; f < face_sizes_.size(); first += face_sizes_[f++]) {
    points.clear();
    for (std::size_t c = 0; c < face_sizes_[f]; ++c) {
      points.push_back(result_.mesh.positions[position_refs_.corners[first + c]]);
    }
    local.clear();
    triangulate(points, local);
    for (const auto& triangle : local) {
      face_of_triangle_.push_back(static_cast<std::uint32_t>(f));
      for (std::size_t k = 0; k < 3; ++k) {
        if (lists[k]->corners.empty()) continue;
        for (const std::uint32_t c : triangle)
          cut[k].push_back(lists[k]->corners[first + c]);
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k)
    lists[k]->corners = std::move(cut[k]);
}

/// Where every corner names the value of its vertex's own number, the indices say nothing and are left out.
template <class T>
void ObjReader::build(CornerAttribute<T>& attribute, IndexedList& list, std::vector<T>& values) {
  attribute.values = std::move(values);
  if (attribute.values.size() == result_.mesh.positions.size() && list.corners == position_refs_.corners) return;
  attribute.indices = std::move(list.corners);
}

void ObjReader::fill_missing_normals() {
  std::size_t filled = 0;
  std::vector<std::uint32_t>& indices = normal_refs_.corners;
  const std::vector<Vec3>& positions = result_.mesh.positions;
  for (std::size_t first = 0; first < indices.size(); first += 3) {
    std::uint32_t flat = kInvalidId;
    for (std::size_t c = first; c < first + 3; ++c) {
      if (indices[c] != kInvalidId) continue;
      if (flat == kInvalidId) {
        const DVec3 a(positions[position_refs_.corners[first]]);
        const DVec3 n = glm::cross(DVec3(positions[position_refs_.corners[first + 1]]) - a,
                                   DVec3(positions[position_refs_.corners[first + 2]]) - a);
        const double length = std::sqrt(glm::dot(n, n));
        flat = static_cast<std::uint32_t>(normals_.size());
        normals_.push_back(length > 0.0 ? Vec3(n / length) : Vec3(0.0f));
      }
      indices[c] = flat;
      ++filled;
    }
  }
  if (filled != 0) result_.notes.push_back(std::to_string(filled) + " corners without a normal given their face's");
}

void ObjReader::fill_missing_uvs() {
  std::size_t filled = 0;
  const auto zero = static_cast<std::uint32_t>(uvs_.size());
  for (std::uint32_t& index : uv_refs_.corners) {
    if (index != kInvalidId) continue;
    index = zero;
    ++filled;
  }
  if (filled == 0) return;
  uvs_.emplace_back(0.0f, 0.0f);
  result_.notes.push_back(std::to_string(filled) + " corners without a texture coordinate given (0, 0)");
}

void ObjReader::build_materials() {
  ObjMaterials materials(source_.folder, result_.notes);
  if (material_runs_.empty()) {
    if (!libraries_.empty()) result_.notes.push_back("material libraries left out: no face uses a material");
    return;
  }
  for (const std::string& library : libraries_)
    materials.read_libraries(library);
  std::vector<std::uint32_t> index_of_name;
  for (const std::string& name : material_names_)
    index_of_name.push_back(materials.find_or_add(name));
  const std::size_t triangles = result_.mesh.faces.size();
  std::vector<std::uint32_t> of_face(triangles);
  if (material_runs_.front().first > 0) {
    const std::uint32_t none = materials.find_or_add("");
    std::fill(of_face.begin(), of_face.end(), none);
  }
  std::size_t run = 0;
  std::optional<std::uint32_t> current;
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::size_t f = all_triangles_ ? t : face_of_triangle_[t];
    while (run < material_runs_.size() && material_runs_[run].first <= f)
      current = index_of_name[material_runs_[run++].second];
    if (current) of_face[t] = *current;
  }
  result_.mesh.materials = materials.take();
  const bool all_first = std::all_of(of_face.begin(), of_face.end(), [](std::uint32_t m) { return m == 0; });
  if (!all_first) result_.mesh.face_materials = std::move(of_face);
}

void ObjReader::write_notes() {
  std::vector<std::string>& notes = result_.notes;
  const auto add = [&notes](std::size_t count, const char* what) {
    if (count != 0) notes.push_back(std::to_string(count) + " " + what);
  };
  add(polygons_, "polygons triangulated");
  add(points_and_lines_, "point and line elements left out");
  add(short_faces_, "faces of fewer than three corners left out");
  add(free_form_, "statements of free-form geometry left out");
  add(weighted_, "vertex weights left out");
  if (groups_.size() > 1) add(groups_.size(), "objects and groups merged into one mesh");
  if (smoothing_ && !any_normal_) notes.emplace_back("smoothing groups left out");
  if (colored_ != 0) add(result_.mesh.positions.size() - colored_, "vertices without a colour given white");
  if (!uvs_.empty() && !any_uv_) add(uvs_.size(), "texture coordinates that no face uses left out");
  if (!normals_.empty() && !any_normal_) add(normals_.size(), "normals that no face uses left out");
  if (unknown_ != 0) {
    notes.push_back(std::to_string(unknown_) + " statements not understood and left out, the first \"" +
                    first_unknown_ + "\" in line " + std::to_string(first_unknown_line_));
  }
}

bool ObjReader::finish() {
  Mesh& mesh = result_.mesh;
  if (!any_statement_) {
    return fail_at_line(1, source_.bytes.empty() ? "the file is empty" : "holds no OBJ statement",
                        "check that it is a Wavefront OBJ file");
  }
  if (!check_forward(position_refs_, mesh.positions.size()) || !check_forward(uv_refs_, uvs_.size()) ||
      !check_forward(normal_refs_, normals_.size())) {
    return false;
  }
  any_uv_ = names_any(uv_refs_);
  any_normal_ = names_any(normal_refs_);
  write_notes();
  const std::size_t corners = position_refs_.corners.size();
  if (any_uv_) uv_refs_.corners.resize(corners, kInvalidId);
  if (any_normal_) normal_refs_.corners.resize(corners, kInvalidId);
  if (!any_uv_) uv_refs_.corners.clear();
  if (!any_normal_) normal_refs_.corners.clear();
  if (!all_triangles_) cut_polygons();
  if (any_uv_) fill_missing_uvs();
  if (any_normal_) fill_missing_normals();
  if (colored_ != 0) mesh.colors.values.resize(mesh.positions.size(), Vec4(1.0f));
  mesh.faces.resize(position_refs_.corners.size() / 3);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c)
      mesh.faces[f][c] = position_refs_.corners[3 * f + c];
  }
  if (any_uv_) build(mesh.uvs, uv_refs_, uvs_);
  if (any_normal_) build(mesh.normals, normal_refs_, normals_);
  build_materials();
  return true;
}

Result<ImportedMesh> ObjReader::read() {
  result_.format = MeshFormat::kObj;
  if (!read_lines() || !finish()) return tl::unexpected(*std::move(error_));
  return std::move(result_);
}

}  // namespace

Result<ImportedMesh> read_obj(const Source& source) try {
  return ObjReader(source).read();
} catch (const std::bad_alloc&) {
  return fail_at(ErrorCode::kUnreadable, source.name, {}, "not enough memory for the model");
} catch (const std::length_error&) {
  return fail_at(ErrorCode::kUnreadable, source.name, {}, "not enough memory for the model");
}

}  // namespace limn::formats
