// What a compacted list is drawn and processed with: a draw of one instance an entry, a dispatch of one invocation an entry,
// and the number of entries there would be with room for all (render/compaction.h).

layout(std430, binding = 4) buffer Command { uint command[8]; };

uniform uint capacity;
uniform uint vertices_per_entry;

void write_command(uint total) {
  uint entries = min(total, capacity);
  uint groups = entries / kWorkgroupSize + (entries % kWorkgroupSize == 0u ? 0u : 1u);
  command[0] = vertices_per_entry;
  command[1] = entries;
  command[2] = 0u;
  command[3] = 0u;
  command[4] = min(groups, kWorkgroupsARow);
  command[5] = (groups + kWorkgroupsARow - 1u) / kWorkgroupsARow;
  command[6] = 1u;
  command[7] = total;
}
