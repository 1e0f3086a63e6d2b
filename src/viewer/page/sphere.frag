#version 300 es
// The sphere, or the disc that the cut leaves of it, along one line of sight: exact.
precision highp float;
in vec2 at;
flat in vec4 ball;
flat in vec3 base;
flat in float own;
uniform vec3 extent;
uniform vec3 cutNormal;  // as the eye sees it
uniform float pixel;     // its length
uniform vec3 background, accent;
uniform float flatView;
uniform float discsOnly;  // of balls within spheres nothing else is drawn
layout(location = 0) out vec4 outColour;  // and how much what stands around it shades it
layout(location = 1) out vec4 outHeight;  // towards the eye, in three bytes

const vec3 day = vec3(1.0, 0.985, 0.95);
// Red goes first: shadows are cool.
vec3 darker(vec3 c, float by) { return c * (1.0 - vec3(0.80, 0.84, 0.66) * by); }

void main() {
  float squared = dot(at, at);
  if (squared > 1.0) discard;
  float r = ball.y, half_chord = sqrt(1.0 - squared);
  vec3 normal = vec3(at, half_chord);
  float z = half_chord;
  vec3 shaded;
  float strength = 1.0;  // of what stands around it
  if (ball.z < 1.0 && dot(cutNormal, normal) > ball.z) {
    if (cutNormal.z <= 1e-4) discard;
    z = (ball.z - dot(cutNormal.xy, at)) / cutNormal.z;
    if (abs(z) > half_chord) discard;
    vec3 p = vec3(at, z);
    float disc = sqrt(max(0.0, 1.0 - ball.z * ball.z));
    float from_rim = (disc - length(p - ball.z * cutNormal)) * r / pixel;
    float rim = clamp(0.12 * disc * r / pixel, 0.6, 1.8);
    vec3 face = flatView > 0.5 ? base : mix(base, day, 0.22);
    shaded = discsOnly > 0.5 ? face : mix(darker(base, 0.55), face, smoothstep(rim - 0.6, rim + 0.6, from_rim));
    if (ball.w > 0.5) shaded = mix(accent, shaded, smoothstep(2.2 * rim, 2.2 * rim + 1.5, from_rim));
    strength = 0.25;
  } else if (discsOnly > 0.5) {
    discard;
  } else {
    float lit = 0.5 + 0.5 * dot(normal, normalize(vec3(-0.45, 0.65, 0.62)));
    float gleam = pow(max(0.0, dot(normal, normalize(vec3(-0.28, 0.42, 0.86)))), 24.0);
    shaded = mix(darker(base, 0.72), mix(base, day, 0.14), smoothstep(0.1, 0.95, lit));
    shaded = mix(shaded, day, 0.30 * gleam);
    shaded = darker(shaded, 0.35 * pow(1.0 - half_chord, 3.0));
    if (ball.w > 0.5) shaded = mix(mix(shaded, accent, 0.35), accent, smoothstep(0.70, 0.76, sqrt(squared)));
  }
  outColour = vec4(mix(background, shaded, own), strength * own);
  float height = 0.5 + 0.5 * (ball.x + r * z) / extent.z;
  vec3 bytes = fract(height * vec3(1.0, 255.0, 65025.0));
  outHeight = vec4(bytes - bytes.yzz * vec3(1.0 / 255.0, 1.0 / 255.0, 0.0), 1.0);
#ifdef EXACT
  gl_FragDepth = 1.0 - height - 1e-6 * discsOnly;
#endif
}
