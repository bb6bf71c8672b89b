#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/context.h"

namespace limn {

/// How a list is compacted on the graphics device. Both give the same list (docs/gpu-extraction.md).
enum class Compaction {
  kHistogramPyramid,  ///< a texture pyramid of sums, descended once an entry: Ziegler et al. 2006, Dyken et al. 2008,
                      ///< section 6.2
  kScan,              ///< block sums, their prefix sums, then a scan within each block: three dispatches
};

/// A compacted list in the device's memory: names of buffers, which belong to who made the list.
struct GpuList {
  unsigned entries = 0;      ///< one uint an entry: its element; ascending
  unsigned copies = 0;       ///< one uint an entry: which of its element's entries it is, from 0; 0 unless asked for
  unsigned command = 0;      ///< eight uints, see below
  std::size_t capacity = 0;  ///< entries there is room for
};

/// Where in GpuList::command what begins, in bytes.
inline constexpr std::size_t kDrawCommandOffset = 0;  ///< of glDrawArraysIndirect: one instance an entry
inline constexpr std::size_t kListSizeOffset = 4;     ///< the number of entries, at most the capacity
/// Of glDispatchComputeIndirect: one invocation an entry, in rows of up to 1024 workgroups of 256 (compute.glsl).
inline constexpr std::size_t kDispatchCommandOffset = 16;
inline constexpr std::size_t kTotalOffset = 28;  ///< the number of entries with room for all

struct CompactorOptions {
  Compaction method = Compaction::kScan;
  std::size_t elements = 0;         ///< at most 2^28
  std::size_t capacity = 0;         ///< room for so many entries; those behind are left out
  bool copies = false;              ///< fill GpuList::copies
  unsigned vertices_per_entry = 2;  ///< of the draw command: 2 draws lines
};

/// Makes a compacted list of counted elements on the graphics device: from one count an element a list in which each
/// element stands as often as its count says, in ascending order. Keeps what it needs between runs; nothing is
/// transferred. Belongs to the context's thread and must not outlive the context.
class Compactor {
 public:
  /// Memory on the device: the entries; kScan 4 bytes every 4,096 elements; kHistogramPyramid 16/3 bytes an element of
  /// the next power of four.
  /// Errors: kNoGraphics when the device cannot do or hold it (one storage buffer holds the counts, one the entries).
  static Result<Compactor> create(gl::Context& context, const CompactorOptions& options);
  ~Compactor();
  Compactor(Compactor&& other) noexcept;
  Compactor& operator=(Compactor&& other) noexcept;

  /// The uints a buffer of counts must have: whole blocks, those behind the last element 0.
  static std::size_t padded_size(std::size_t elements);

  /// Submits the work; the list is there for any later use on the device without a barrier by the caller.
  /// \param counts  name of a buffer of padded_size(elements) uints, which sum to less than 2^32. What wrote them must
  /// be followed by a storage barrier.
  /// Dispatches: 3 (kScan), or 3 and one for each halving of the base's side (kHistogramPyramid), whatever the counts.
  /// The same counts give the same bits. Leaves the context current and changes its program and bindings.
  void run(unsigned counts) const;

  GpuList list() const;

  /// The entries, once the device has done its work: two transfers, of 4 bytes and of the entries.
  std::vector<std::uint32_t> read_entries() const;

 private:
  struct Impl;
  explicit Compactor(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
