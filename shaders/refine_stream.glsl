// A corner of a triangle of the refined mesh that lives on the device as a stream (render/refinement/published/dmr.h): the face; the place on
// it, as patterns' vertices are stored; which of the face's triangles this is, and how many it has less one, 16 bits each.

layout(location = 0) in uvec3 stream_corner;
