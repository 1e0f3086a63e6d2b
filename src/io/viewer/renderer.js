// Draws spheres, walls and lines. One draw call each; nothing is made in a frame.
import { programOf, sphereFragment } from "./shaders.js";

export class Renderer {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, stencil: false });
    if (!this.gl) throw new Error("no WebGL 2");
    this.make();
  }

  // All that is lost with a context.
  make() {
    const gl = this.gl;
    const texts = shaderTexts;
    this.spheres = programOf(gl, texts["sphere.vert"], sphereFragment(gl, texts["sphere.frag"]));
    this.shading = programOf(gl, texts["whole.vert"], texts["shade.frag"]);
    this.surface = programOf(gl, texts["surface.vert"], texts["surface.frag"]);
    this.lines = programOf(gl, texts["line.vert"], texts["line.frag"]);
    this.nothing = gl.createVertexArray();
    this.groups = [];
    this.walls = this.edges = null;
    this.width = this.height = 0;
    this.extent = new Float32Array(3);
    this.cutNormal = new Float32Array(3);
  }

  buffer(values, target = this.gl.ARRAY_BUFFER) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(target, buffer);
    this.gl.bufferData(target, values, this.gl.STATIC_DRAW);
    return buffer;
  }
  vertices(attributes, each) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    attributes.forEach(([buffer, size, type, stride, offset], k) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, size, type, type === gl.UNSIGNED_BYTE, stride, offset);
      gl.vertexAttribDivisor(k, each);
    });
    return array;
  }

  // Group 0 are the spheres, group 1 their images; four numbers and four bytes each.
  setSpheres(group, spheres, colours) {
    const gl = this.gl, old = this.groups[group];
    if (old) {
      gl.deleteVertexArray(old.array);
      gl.deleteBuffer(old.places);
      gl.deleteBuffer(old.colours);
    }
    const places = this.buffer(spheres), colour = this.buffer(colours);
    const array = this.vertices([[places, 4, gl.FLOAT, 0, 0], [colour, 4, gl.UNSIGNED_BYTE, 0, 0]], 1);
    this.groups[group] = { array, places, colours: colour, count: spheres.length / 4 };
  }
  setColours(group, colours) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.groups[group].colours);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, colours);
  }
  setWalls({ vertices, triangles, lines }) {
    const gl = this.gl;
    if (triangles.length > 0) {
      const array = this.vertices([[this.buffer(vertices), 3, gl.FLOAT, 0, 0]], 0);
      this.buffer(triangles, gl.ELEMENT_ARRAY_BUFFER);
      this.walls = { array, count: triangles.length };
    }
    const ends = this.buffer(lines);
    this.edges = { count: lines.length / 6,
                   array: this.vertices([[ends, 3, gl.FLOAT, 24, 0], [ends, 3, gl.FLOAT, 24, 12]], 1) };
    gl.bindVertexArray(null);
  }

  texture(format, type, internal, width, height) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, format, type, null);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
                                 [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, name, value);
    return texture;
  }
  // The buffers of a picture of so many pixels, which may be more or fewer than those of the canvas.
  resize(width, height) {
    if (width === this.width && height === this.height) return;
    const gl = this.gl;
    for (const name of ["colour", "depth", "shaded"]) if (this[name]) gl.deleteTexture(this[name]);
    for (const name of ["first", "second"]) if (this[name]) gl.deleteFramebuffer(this[name]);
    this.colour = this.texture(gl.RGBA, gl.UNSIGNED_BYTE, gl.RGBA8, width, height);
    this.depth = this.texture(gl.DEPTH_COMPONENT, gl.UNSIGNED_INT, gl.DEPTH_COMPONENT24, width, height);
    this.shaded = this.texture(gl.RGBA, gl.UNSIGNED_BYTE, gl.RGBA8, width, height);
    this.first = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.first);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.colour, 0);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    this.second = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.second);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.shaded, 0);
    this.width = width;
    this.height = height;
  }

  use({ program, at }, camera, cut, theme) {
    const gl = this.gl;
    gl.useProgram(program);
    gl.uniform3fv(at.right, camera.right);
    gl.uniform3fv(at.up, camera.up);
    gl.uniform3fv(at.eye, camera.eye);
    gl.uniform3fv(at.target, camera.target);
    gl.uniform3fv(at.extent, this.extent);
    gl.uniform4fv(at.cut, cut);
    if (at.tint) gl.uniform3fv(at.tint, theme.line);
    if (at.depths) gl.uniform1i(at.depths, 1);
  }

  // `scene`: {camera, radius and center of all there is, cut, theme, selected, most, images, walls, lines, rings,
  // meanRadius, flat, scale: pixels of the picture to one of the canvas}.
  draw(scene) {
    const gl = this.gl, { camera, cut, theme, scale } = scene;
    const canvas = this.canvas;
    this.resize(Math.max(1, Math.round(scale * canvas.width)), Math.max(1, Math.round(scale * canvas.height)));
    const pixel = (2 * camera.half) / this.height;
    const off = Math.hypot(camera.target[0] - scene.center[0], camera.target[1] - scene.center[1],
                           camera.target[2] - scene.center[2]);
    this.extent[0] = camera.half * camera.aspect;
    this.extent[1] = camera.half;
    this.extent[2] = 1.01 * (scene.radius + off);
    const dot = (a) => cut[0] * a[0] + cut[1] * a[1] + cut[2] * a[2];
    this.cutNormal[0] = dot(camera.right);
    this.cutNormal[1] = dot(camera.up);
    this.cutNormal[2] = dot(camera.eye);

    gl.viewport(0, 0, this.width, this.height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.first);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.use(this.spheres, camera, cut, theme);
    const at = this.spheres.at;
    gl.uniform3fv(at.cutNormal, this.cutNormal);
    gl.uniform3fv(at.background, theme.background);
    gl.uniform3fv(at.accent, theme.accent);
    gl.uniform1f(at.pixel, pixel);
    gl.uniform1f(at.smallest, 0.6 * pixel);
    gl.uniform1f(at.flatView, scene.flat ? 1 : 0);
    for (let group = 0; group < this.groups.length; ++group) {
      const { array, count } = this.groups[group];
      if (group === 1 && !scene.images) continue;
      gl.uniform1i(at.selected, scene.selectedGroup === group ? scene.selected : -1);
      gl.bindVertexArray(array);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, group === 0 ? Math.min(count, scene.most) : count);
    }

    gl.bindFramebuffer(gl.FRAMEBUFFER, this.second);
    gl.disable(gl.DEPTH_TEST);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.colour);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.depth);
    this.use(this.shading, camera, cut, theme);
    gl.uniform1i(this.shading.at.colours, 0);
    gl.uniform3fv(this.shading.at.background, theme.background);
    gl.uniform1f(this.shading.at.pixel, pixel);
    gl.uniform1f(this.shading.at.reach, Math.min(0.06 * this.height, Math.max(2, scene.meanRadius / pixel)));
    gl.uniform1i(this.shading.at.rings, scene.flat ? 0 : scene.rings);
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);

    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    if (this.walls && scene.walls) {
      this.use(this.surface, camera, cut, theme);
      gl.bindVertexArray(this.walls.array);
      gl.drawElements(gl.TRIANGLES, this.walls.count, gl.UNSIGNED_INT, 0);
    }
    if (this.edges && scene.lines) {
      this.use(this.lines, camera, cut, theme);
      gl.uniform1f(this.lines.at.width, 0.65 * scene.density * scale * pixel);
      gl.uniform1f(this.lines.at.hidden, scene.flat ? 0.85 : 0.16);
      gl.bindVertexArray(this.edges.array);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.edges.count);
    }
    gl.bindVertexArray(null);

    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.second);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, this.width, this.height, 0, 0, canvas.width, canvas.height, gl.COLOR_BUFFER_BIT,
                       gl.LINEAR);
  }
}
