#version 300 es
// A triangle that faces the eye, around one sphere: the sphere of vertices 3 i, 3 i + 1 and 3 i + 2 is in texel i. As the lines of sight are parallel, disjoint spheres hide each other
// rightly if each has the depth of its centre, whatever their sizes and whatever a cut leaves of them: the plane of equal
// power separates two of them, and the eye's side of it is that of the nearer centre. Spheres that overlap need the depth
// of every point (EXACT).
precision highp float;
precision highp sampler2D;
uniform sampler2D spheres, tints;
uniform vec3 right, up, eye, target;
uniform vec3 extent;  // half of the width and height that are seen, and of the depth
uniform vec4 cut;     // (n, d): what has n.p > d is taken away; n = 0: nothing
uniform float smallest;  // radius that is drawn
uniform int selected;
out vec2 at;
flat out vec4 ball;   // height towards the eye, radius, distance of the cut from the centre in radii, selected
flat out vec3 base;
flat out float own;   // 1, or how little an image is faded

const vec2 corners[3] = vec2[3](vec2(-1.7320508, -1.0), vec2(1.7320508, -1.0), vec2(0.0, 2.0));

void main() {
  int number = gl_VertexID / 3, row = textureSize(spheres, 0).x;
  ivec2 texel = ivec2(number % row, number / row);
  vec4 sphere = texelFetch(spheres, texel, 0), colour = texelFetch(tints, texel, 0);
  at = corners[gl_VertexID - 3 * number];
  float r = max(sphere.w, smallest);
  vec3 c = sphere.xyz - target;
  float height = dot(c, eye);
  float beyond = dot(cut.xyz, cut.xyz) > 0.0 ? (cut.w - dot(cut.xyz, sphere.xyz)) / r : 2.0;
  ball = vec4(height, r, beyond, number == selected ? 1.0 : 0.0);
  base = colour.rgb;
  own = colour.a;
  vec2 place = vec2(dot(c, right), dot(c, up)) + r * at;
#ifdef EXACT
  height += r;  // in front of all of it
#endif
  gl_Position = vec4(place / extent.xy, -height / extent.z, 1.0);
  if (beyond < -1.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
