#version 300 es
// A square that faces the eye, around one sphere and in front of it.
precision highp float;
layout(location = 0) in vec4 sphere;
layout(location = 1) in vec4 colour;
uniform vec3 right, up, eye, target;
uniform vec3 extent;  // half of the width and height that are seen, and of the depth
uniform vec4 cut;     // (n, d): what has n.p > d is taken away; n = 0: nothing
uniform float smallest;  // radius that is drawn
uniform int selected;
out vec2 at;
flat out vec4 ball;   // height towards the eye, radius, distance of the cut from the centre in radii, selected
flat out vec3 base;
flat out float own;   // 1, or how little an image is faded

void main() {
  at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  float r = max(sphere.w, smallest);
  vec3 c = sphere.xyz - target;
  float height = dot(c, eye);
  float beyond = dot(cut.xyz, cut.xyz) > 0.0 ? (cut.w - dot(cut.xyz, sphere.xyz)) / r : 2.0;
  ball = vec4(height, r, beyond, gl_InstanceID == selected ? 1.0 : 0.0);
  base = colour.rgb;
  own = colour.a;
  vec2 place = vec2(dot(c, right), dot(c, up)) + r * at;
  gl_Position = vec4(place / extent.xy, -(height + r) / extent.z, 1.0);
  if (beyond < -1.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
