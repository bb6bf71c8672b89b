#include "limn/gl/shader_library.h"

#include <algorithm>

#include "limn/base/file.h"
#include "limn/gl/embedded_shaders.h"

namespace limn::gl {
namespace {

/// NAME of a line `#include "NAME"`, else empty.
std::string_view included_name(std::string_view line) {
  constexpr std::string_view kStart = "#include \"";
  if (line.substr(0, kStart.size()) != kStart) return {};
  const std::string_view rest = line.substr(kStart.size());
  return rest.substr(0, std::min(rest.find('"'), rest.size()));
}

}  // namespace

Result<std::string> ShaderLibrary::file(std::string_view name) const {
  if (!folder_.empty()) {
    const auto bytes = FileBytes::open(folder_ / name);
    if (!bytes) return tl::unexpected(bytes.error());
    return std::string(bytes->text());
  }
  for (const EmbeddedShader& shader : embedded_shaders()) {
    if (shader.name == name) return std::string(shader.text);
  }
  return fail_at(ErrorCode::kUnreadable, std::string(name), {}, "no such shader is built in");
}

Result<void> ShaderLibrary::expand(std::string_view name, std::vector<std::string>& seen, std::string& text) const {
  if (std::find(seen.begin(), seen.end(), name) != seen.end()) return {};
  const std::size_t number = seen.size();
  seen.emplace_back(name);
  const auto content = file(name);
  if (!content) return tl::unexpected(content.error());
  std::size_t line_number = 1;
  for (std::size_t at = 0; at < content->size(); ++line_number) {
    const std::size_t end = std::min(content->find('\n', at), content->size());
    const std::string_view line = std::string_view(*content).substr(at, end - at);
    at = end + 1;
    const std::string_view inner = included_name(line);
    if (inner.empty()) {
      text.append(line).append("\n");
      continue;
    }
    // "#line LINE SOURCE" keeps a compiler's messages in terms of the files: sources are numbered as they are met.
    text += "#line 1 " + std::to_string(seen.size()) + "\n";
    if (auto done = expand(inner, seen, text); !done) return done;
    text += "#line " + std::to_string(line_number + 1) + " " + std::to_string(number) + "\n";
  }
  return {};
}

Result<std::string> ShaderLibrary::source(std::string_view name, const std::vector<std::string>& defines) const {
  std::vector<std::string> seen;
  std::string text;
  if (auto done = expand(name, seen, text); !done) return tl::unexpected(done.error());
  if (defines.empty()) return text;
  std::string inserted;
  for (const std::string& define : defines)
    inserted += "#define " + define + "\n";
  const std::size_t after_version = std::min(text.find('\n'), text.size() - 1) + 1;
  return text.insert(after_version, inserted + "#line 2 0\n");
}

}  // namespace limn::gl
