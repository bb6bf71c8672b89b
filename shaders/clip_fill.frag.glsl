#version 450 core
// Full coverage, wherever the stencil lets it pass.

layout(location = 0) out vec4 color;

void main() {
  color = vec4(0.0, 0.0, 0.0, 1.0);
}
