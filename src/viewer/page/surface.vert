#version 300 es
// The container's surface.
precision highp float;
layout(location = 0) in vec3 vertex;
uniform vec3 right, up, eye, target, extent;
out vec3 seen, place;

void main() {
  vec3 p = vertex - target;
  place = vertex;
  seen = vec3(dot(p, right), dot(p, up), dot(p, eye));
  gl_Position = vec4(seen.xy / extent.xy, -seen.z / extent.z, 1.0);
}
