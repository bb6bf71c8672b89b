// A workgroup's kSortBlock refined faces, and for each group how they are counted: one invocation a group looks at all of
// them in order, so that what comes out does not depend on which invocation is faster.

shared uint block_keys[kSortBlock];

uint refined_of_block() {
  return min(kSortBlock, frame[2] - workgroup_index() * kSortBlock);
}

/// The keys' groups; every invocation must take part.
void load_groups(uint count) {
  for (uint i = gl_LocalInvocationIndex; i < count; i += kWorkgroupSize)
    block_keys[i] = key_group(lists[refined_slot(workgroup_index() * kSortBlock + i) + 1u]);
  barrier();
}
