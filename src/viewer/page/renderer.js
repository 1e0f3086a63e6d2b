// Draws spheres, walls and lines. One draw call each; nothing is made in a frame. First the spheres: their colours and
// their heights towards the eye; then their shading, walls and lines over it, in a picture that may have more pixels than
// the canvas, or fewer.
import { programOf, exact } from "./shaders.js";

export const ROW = 1024;  // spheres in a row of a texture
export const wholeRows = (count) => ROW * Math.ceil(count / ROW);

export class Renderer {
  // `overlap`: whether spheres may reach into each other, which takes longer to draw.
  constructor(canvas, overlap) {
    this.canvas = canvas;
    this.overlap = overlap;
    this.gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, stencil: false });
    if (!this.gl) throw new Error("no WebGL 2");
    this.make();
  }

  // All that is lost with a context.
  make() {
    const gl = this.gl;
    const texts = shaderTexts;
    const variant = (text) => (this.overlap ? exact(gl, text) : text);
    this.spheres = programOf(gl, variant(texts["sphere.vert"]), variant(texts["sphere.frag"]));
    this.shading = programOf(gl, texts["whole.vert"], texts["shade.frag"]);
    this.copy = programOf(gl, texts["whole.vert"], texts["copy.frag"]);
    this.surface = programOf(gl, texts["surface.vert"], texts["surface.frag"]);
    this.lines = programOf(gl, texts["line.vert"], texts["line.frag"]);
    this.nothing = gl.createVertexArray();
    this.groups = [];
    this.colour = this.heights = this.shaded = this.depth = this.first = this.second = null;
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
  // Of three numbers each.
  vertices(buffer, stride, ...offsets) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    offsets.forEach((offset, k) => {
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, 3, gl.FLOAT, false, stride, offset);
    });
    return array;
  }

  // Group 0 are the spheres, group 1 their images, group 2 the balls in which their layers end, of which only what a cut
  // leaves is drawn, over the discs of whole spheres, as those come later at the same depth; four numbers and four bytes each, of which `count` are drawn. Arrays
  // are whole rows of ROW.
  setSpheres(group, spheres, tints, count) {
    const gl = this.gl, rows = spheres.length / (4 * ROW);
    if (!this.groups[group])
      this.groups[group] = { spheres: this.texture(ROW, rows, gl.RGBA32F), tints: this.texture(ROW, rows) };
    const needed = Math.min(rows, Math.ceil(count / ROW));
    const fill = (texture, type, values) => {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ROW, needed, gl.RGBA, type, values);
    };
    gl.activeTexture(gl.TEXTURE0);
    fill(this.groups[group].spheres, gl.FLOAT, spheres);
    fill(this.groups[group].tints, gl.UNSIGNED_BYTE, tints);
    this.groups[group].count = count;
  }
  setShells({ balls, tints, count }) {
    const whole = new Float32Array(4 * wholeRows(count)), bytes = new Uint8Array(4 * wholeRows(count));
    whole.set(balls);
    bytes.set(tints);
    this.setSpheres(2, whole, bytes, count);
  }
  setWalls({ vertices, triangles, lines }) {
    const gl = this.gl;
    if (triangles.length > 0) {
      const array = this.vertices(this.buffer(vertices), 0, 0);
      this.buffer(triangles, gl.ELEMENT_ARRAY_BUFFER);
      this.walls = { array, count: triangles.length };
    }
    const ends = new Float32Array(6 * lines.length);
    for (let k = 0; k < ends.length; ++k) ends[k] = lines[6 * Math.floor(k / 36) + (k % 6)];
    this.edges = { count: lines.length, array: this.vertices(this.buffer(ends), 24, 0, 12) };
    gl.bindVertexArray(null);
  }

  texture(width, height, format = this.gl.RGBA8) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, Math.max(1, height));
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
                                 [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, name, value);
    return texture;
  }
  target(...textures) {
    const gl = this.gl, target = gl.createFramebuffer(), attached = [];
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    textures.forEach((texture, k) => {
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + k, gl.TEXTURE_2D, texture, 0);
      attached.push(gl.COLOR_ATTACHMENT0 + k);
    });
    gl.drawBuffers(attached);
    return target;
  }
  // The buffers of a picture of so many pixels, which may be more or fewer than those of the canvas.
  resize(width, height) {
    if (width === this.width && height === this.height) return;
    const gl = this.gl;
    for (const name of ["colour", "heights", "shaded"]) gl.deleteTexture(this[name]);
    gl.deleteRenderbuffer(this.depth);
    for (const name of ["first", "second"]) gl.deleteFramebuffer(this[name]);
    for (const name of ["colour", "heights", "shaded"]) this[name] = this.texture(width, height);
    this.depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    this.first = this.target(this.colour, this.heights);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.depth);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);  // the last of them, the shaded picture
    this.second = this.target(this.shaded);
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
    if (at.heights) gl.uniform1i(at.heights, 1);
  }

  // `scene`: {camera, radius and center of all there is, cut, theme, selected, images, walls, lines, rings,
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
    gl.uniform1i(at.spheres, 0);
    gl.uniform1i(at.tints, 1);
    gl.bindVertexArray(this.nothing);
    const cuts = cut[0] !== 0 || cut[1] !== 0 || cut[2] !== 0;
    for (const group of [2, 0, 1]) {
      if (!this.groups[group] || (group === 1 && !scene.images) || (group === 2 && !cuts)) continue;
      const { spheres, tints, count } = this.groups[group];
      gl.uniform1f(at.discsOnly, group === 2 ? 1 : 0);
      gl.uniform1i(at.selected, scene.selectedGroup === group ? scene.selected : -1);
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, spheres);
      gl.activeTexture(gl.TEXTURE1);
      gl.bindTexture(gl.TEXTURE_2D, tints);
      gl.drawArrays(gl.TRIANGLES, 0, 3 * count);
    }

    gl.bindFramebuffer(gl.FRAMEBUFFER, this.second);
    gl.disable(gl.DEPTH_TEST);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.colour);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.heights);
    this.use(this.shading, camera, cut, theme);
    gl.uniform1i(this.shading.at.colours, 0);
    gl.uniform3fv(this.shading.at.background, theme.background);
    gl.uniform1f(this.shading.at.pixel, pixel);
    gl.uniform1f(this.shading.at.reach, Math.min(0.06 * this.height, Math.max(2, scene.meanRadius / pixel)));
    gl.uniform1i(this.shading.at.rings, scene.flat ? 0 : scene.rings);
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
      gl.drawArrays(gl.TRIANGLES, 0, this.edges.count);
    }

    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.BLEND);
    gl.useProgram(this.copy.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.shaded);
    gl.uniform1i(this.copy.at.picture, 0);
    gl.uniform2f(this.copy.at.size, canvas.width, canvas.height);
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.bindVertexArray(null);
  }
}
