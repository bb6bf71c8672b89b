#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn::test {

namespace fs = std::filesystem;

/// What a check found wrong: "FILE:LINE: CAUSE", one entry each. Empty when all is well.
using Problems = std::vector<std::string>;

/// The lines of a text file.
inline std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file, std::ios::binary);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

inline std::string problem(const fs::path& file, std::size_t line, const std::string& cause) {
  return file.generic_string() + ":" + std::to_string(line) + ": " + cause;
}

/// Whether a folder holds no sources: hidden, fetched models, or a build tree.
inline bool is_foreign_folder(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return (name.starts_with('.') && name != ".ci") || name == "build" || name == "models" ||
         fs::exists(folder / "CMakeCache.txt");
}

/// Every file of the source tree in a fixed order, as paths relative to `root`.
inline std::vector<fs::path> files_of(const fs::path& root) {
  std::vector<fs::path> files;
  for (auto it = fs::recursive_directory_iterator(root); it != fs::recursive_directory_iterator(); ++it) {
    if (it->is_directory() && is_foreign_folder(it->path())) it.disable_recursion_pending();
    if (it->is_regular_file()) files.push_back(fs::relative(it->path(), root));
  }
  std::sort(files.begin(), files.end());
  return files;
}

inline bool has_extension(const fs::path& file, std::initializer_list<std::string_view> extensions) {
  return std::find(extensions.begin(), extensions.end(), file.extension().string()) != extensions.end();
}

inline bool lies_in(const fs::path& file, std::initializer_list<std::string_view> folders) {
  return std::find(folders.begin(), folders.end(), file.begin()->string()) != folders.end();
}

/// All problems of a list as one message.
inline std::string joined(const Problems& problems) {
  std::string text;
  for (const std::string& entry : problems)
    text += "\n  " + entry;
  return text;
}

}  // namespace limn::test
