#version 300 es
// A line of some pixels' width: two triangles, whose six vertices have both of its ends.
precision highp float;
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
uniform vec3 right, up, eye, target, extent;
uniform float width;  // half of it, as a length
out vec3 place;

void main() {
  int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
  vec3 there = (corner & 1) == 0 ? from : to;
  vec3 p = there - target, along = to - from;
  vec2 way = vec2(dot(along, right), dot(along, up));
  float size = length(way);
  way = size > 0.0 ? way / size : vec2(1.0, 0.0);
  float side = float(corner >> 1) * 2.0 - 1.0, end = float(corner & 1) * 2.0 - 1.0;
  vec2 seen = vec2(dot(p, right), dot(p, up)) + width * (side * vec2(-way.y, way.x) + 0.5 * end * way);
  place = there;
  gl_Position = vec4(seen / extent.xy, -(dot(p, eye) + 2.0 * width) / extent.z, 1.0);
}
