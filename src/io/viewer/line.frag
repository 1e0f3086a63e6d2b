#version 300 es
// Faint where spheres hide it.
precision highp float;
precision highp sampler2D;
in vec3 place;
uniform sampler2D depths;
uniform vec4 cut;
uniform vec3 tint;
uniform float hidden;
out vec4 outColour;

void main() {
  if (dot(cut.xyz, cut.xyz) > 0.0 && dot(cut.xyz, place) > cut.w) discard;
  bool behind = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r < gl_FragCoord.z;
  float alpha = behind ? hidden : 0.85;
  outColour = vec4(tint * alpha, alpha);
}
