#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "limn/base/result.h"
#include "limn/hull/sequence.h"

namespace limn {

/// A sequence in one file: the shell, then the steps, about 12 bytes a vertex, 4 a face and 15 a step
/// (docs/hull-sequence.md). The shell's sources and notes are left out. Same sequence, same bytes.
std::vector<std::byte> hull_sequence_bytes(const HullSequence& sequence);

/// Reads them back: the same bits at every level.
/// \param name  what errors call the file
/// Cost: linear. Memory: bounded by the length of the bytes.
/// Errors: kUnreadable, saying where and why, when the bytes are cut off, damaged, of another version or another kind,
/// or when a step does not fit the surface, whoever wrote them. Never a mesh with an index out of range.
Result<HullSequence> parse_hull_sequence(std::span<const std::byte> bytes, const std::string& name);

/// Whether the bytes begin as a sequence file does.
bool is_hull_sequence(std::span<const std::byte> bytes);

/// The same to and from a file. Written whole or not at all. Errors: kUnwritable; kUnreadable.
Result<void> save_hull_sequence(const HullSequence& sequence, const std::filesystem::path& path);
Result<HullSequence> load_hull_sequence(const std::filesystem::path& path);

}  // namespace limn
