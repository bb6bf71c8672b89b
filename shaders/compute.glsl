// One invocation an item, in workgroups of 256 and rows of at most 1024 workgroups (gl/compute.h).

layout(local_size_x = 256) in;

const uint kWorkgroupSize = 256u;
const uint kWorkgroupsARow = 1024u;

uint workgroup_index() {
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

uint invocation_index() {
  return workgroup_index() * kWorkgroupSize + gl_LocalInvocationIndex;
}
