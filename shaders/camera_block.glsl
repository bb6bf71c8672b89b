// A frame's camera, the same for every program (render/camera_block.h has its twin, and says what the numbers are).

layout(std140, binding = 0) uniform CameraBlock {
  mat4 rotation;            // world to eye space without its translation
  mat4 projection;
  mat4 inverse_projection;
  vec3 eye;
  float near_distance;
  vec3 world_up;            // in eye space
  float pixel_size;         // world units a pixel: at distance 1, or anywhere when orthographic
  vec2 size_px;
  bool orthographic;
};
