#version 300 es
// The picture as the canvas has its pixels.
precision highp float;
uniform sampler2D picture;
uniform vec2 size;  // of the canvas
out vec4 outColour;

void main() { outColour = vec4(texture(picture, gl_FragCoord.xy / size).rgb, 1.0); }
