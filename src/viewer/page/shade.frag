#version 300 es
// What stands around a point takes light from it, and so does a side of the packing that is turned from the light:
// both are read off the heights of what can be seen, as in the still picture.
precision highp float;
precision highp sampler2D;
uniform sampler2D colours, heights;
uniform vec3 extent, background;
uniform float reach;   // in pixels: about a mean radius
uniform float pixel;   // its length
uniform int rings;     // 0: no shading
out vec4 outColour;

const int directions = 8;
const float golden = 2.39996;

float height(vec2 p) {
  vec3 bytes = texelFetch(heights, clamp(ivec2(p), ivec2(0), textureSize(heights, 0) - 1), 0).rgb;
  return (2.0 * dot(bytes, vec3(1.0, 1.0 / 255.0, 1.0 / 65025.0)) - 1.0) * extent.z;
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  if (texelFetch(heights, here, 0).a == 0.0) {
    outColour = vec4(background, 1.0);
    return;
  }
  vec4 colour = texelFetch(colours, here, 0);
  float shade = 0.0;
  if (rings > 0) {
    float z = height(gl_FragCoord.xy);
    float turn = 6.2832 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    float occlusion = 0.0;
    for (int ring = 0; ring < rings; ++ring) {
      float away = reach * (0.7 + 1.1 * float(ring));
      for (int k = 0; k < directions; ++k) {
        float angle = turn + golden * float(ring) + 0.7853982 * float(k);
        float rise = (height(gl_FragCoord.xy + away * vec2(cos(angle), sin(angle))) - z) / (away * pixel);
        occlusion += clamp(rise / 1.3 - 0.12, 0.0, 1.0);
      }
    }
    shade = 0.85 * occlusion / float(rings * directions);
    vec3 patch_normal = vec3(0.0, 0.0, 1.0);
    float wide = 7.0 * reach;
    for (int k = 0; k < directions; ++k) {
      float angle = turn + 0.7853982 * float(k);
      vec2 way = vec2(cos(angle), sin(angle));
      patch_normal.xy -= way * clamp((height(gl_FragCoord.xy + wide * way) - z) / (wide * pixel), -1.6, 1.6) / 4.0;
    }
    float away_from_light = 0.5 - 0.5 * dot(normalize(patch_normal), normalize(vec3(-0.5, 0.75, 0.75)));
    shade = clamp(shade + 0.65 * (away_from_light - 0.2), 0.0, 0.85) * colour.a;
  }
  outColour = vec4(colour.rgb * (1.0 - vec3(0.80, 0.84, 0.66) * shade), 1.0);
}
