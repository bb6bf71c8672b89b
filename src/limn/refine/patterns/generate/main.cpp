// Writes the source that holds the patterns of both families up to kStoredPatternLevel: write_patterns FILE.

#include <cstdio>
#include <fstream>

#include "limn/refine/patterns/table.h"

namespace {

using namespace limn;

void write(std::ofstream& out, const char* name, const PatternTable& table) {
  out << "constexpr PatternRange k" << name << "Ranges[] = {\n";
  for (const PatternRange& r : table.ranges) {
    out << '{' << r.first_vertex << ',' << r.vertex_count << ',' << r.first_triangle << ',' << r.triangle_count
        << "},\n";
  }
  out << "};\nconstexpr std::uint32_t k" << name << "Vertices[] = {\n";
  for (std::size_t n = 0; n < table.vertices.size(); ++n)
    out << table.vertices[n] << (n % 16 == 15 ? ",\n" : ",");
  out << "};\nconstexpr PatternTriangle k" << name << "Triangles[] = {\n";
  for (std::size_t n = 0; n < table.triangles.size(); ++n) {
    const PatternTriangle& t = table.triangles[n];
    out << "{{" << t[0] << ',' << t[1] << ',' << t[2] << (n % 8 == 7 ? "}},\n" : "}},");
  }
  out << "};\n";
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: write_patterns FILE\n", stderr);
    return 2;
  }
  std::ofstream out(arguments[1], std::ios::binary);
  out << "// Written by src/limn/refine/patterns/generate.\n#include \"limn/refine/patterns/stored.h\"\n\n"
         "namespace limn {\nnamespace {\n\n";
  write(out, "Nested", make_pattern_table(PatternFamily::kNested, kStoredPatternLevel));
  write(out, "Minimal", make_pattern_table(PatternFamily::kMinimal, kStoredPatternLevel));
  out << "\n}  // namespace\n\nStoredPatterns stored_patterns(PatternFamily family) {\n"
         "  if (family == PatternFamily::kNested) return {kNestedRanges, kNestedVertices, kNestedTriangles};\n"
         "  return {kMinimalRanges, kMinimalVertices, kMinimalTriangles};\n}\n\n}  // namespace limn\n";
  out.close();
  if (out) return 0;
  std::fprintf(stderr, "write_patterns: %s could not be written\n", arguments[1]);
  return 1;
}
