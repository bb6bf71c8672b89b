// Groups of refined faces that share a pattern and a winding, and how each pattern lies in the device's memory
// (render/refinement/pattern_buffers.h).

struct PatternDraw {
  uint index_count;        // of all faces of an instance
  uint first_index[2];     // as stored, mirrored
  uint base_vertex;
  uint faces_an_instance;  // 4 or 1
  uint triangles;          // of one face
  uint vertices;           // of one face
  uint border;             // of these, on its border; they come first
  uint batch;              // faces an instance where vertices are stored
  uint batch_index_count;
  uint batch_first_index[2];
  uint halvings;           // of sides 0, 1, 2, four bits each
};
layout(std430, binding = 7) readonly buffer Draws { PatternDraw draws[]; };

const uint kNoFace = 0xffffffffu;
const uint kCommandUints = 5u;
const uint kFirstCommand = 5u;  // behind that of the unrefined triangles

const uint kAlignment = 16u;            // groups begin at multiples of it, the largest batch

/// Where a group's entries begin and how many they are, and its first vertex when all groups' are stored one after the other,
/// gaps included.
struct GroupRange {
  uint start, count, vertex;
};

/// Behind the commands: unrefined triangles', three a group.
uint group_at(uint group) { return kFirstCommand + 3u * group_count * kCommandUints + 3u * group; }

void put_group(uint group, GroupRange range) {
  uint at = group_at(group);
  commands[at] = range.start;
  commands[at + 1u] = range.count;
  commands[at + 2u] = range.vertex;
}

GroupRange group_range(uint group) {
  uint at = group_at(group);
  return GroupRange(commands[at], commands[at + 1u], commands[at + 2u]);
}

/// The group that an entry of the sorted list belongs to.
uint group_of_entry(uint entry) {
  uint low = 0u;
  uint high = group_count;  // the first group beyond it
  while (high - low > 1u) {
    uint middle = (low + high) / 2u;
    if (commands[group_at(middle)] <= entry) low = middle; else high = middle;
  }
  return low;
}
