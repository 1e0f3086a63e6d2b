#version 300 es
// Faint where spheres hide it.
precision highp float;
precision highp sampler2D;
in vec3 place;
uniform sampler2D heights;
uniform vec4 cut;
uniform vec3 tint;
uniform float hidden;
out vec4 outColour;

bool isHidden() {
  vec3 bytes = texelFetch(heights, ivec2(gl_FragCoord.xy), 0).rgb;
  return dot(bytes, vec3(1.0, 1.0 / 255.0, 1.0 / 65025.0)) > 1.0 - gl_FragCoord.z;
}

void main() {
  if (dot(cut.xyz, cut.xyz) > 0.0 && dot(cut.xyz, place) > cut.w) discard;
  bool behind = isHidden();
  float alpha = behind ? hidden : 0.85;
  outColour = vec4(tint * alpha, alpha);
}
