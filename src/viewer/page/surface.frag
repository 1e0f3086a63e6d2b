#version 300 es
// Like a film of glass: denser where it is seen edgewise. What spheres hide is left out.
precision highp float;
precision highp sampler2D;
in vec3 seen, place;
uniform sampler2D heights;
uniform vec4 cut;
uniform vec3 tint;
out vec4 outColour;

bool isHidden() {
  vec3 bytes = texelFetch(heights, ivec2(gl_FragCoord.xy), 0).rgb;
  return dot(bytes, vec3(1.0, 1.0 / 255.0, 1.0 / 65025.0)) > 1.0 - gl_FragCoord.z;
}

void main() {
  if (dot(cut.xyz, cut.xyz) > 0.0 && dot(cut.xyz, place) > cut.w) discard;
  if (isHidden()) discard;
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  float alpha = mix(gl_FrontFacing ? 0.03 : 0.09, 0.34, pow(1.0 - abs(normal.z), 2.5));
  float lit = 0.75 + 0.25 * dot(normal * sign(normal.z), normalize(vec3(-0.5, 0.75, 0.75)));
  outColour = vec4(tint * lit * alpha, alpha);
}
