// One view in a page: its state, and when it is drawn.
import { decode } from "./data.js";
import { scaleOf, colourBytes } from "./colours.js";
import { Camera } from "./camera.js";
import { wallsOf } from "./walls.js";
import { imagesOf } from "./images.js";
import { Order } from "./order.js";
import { Renderer, wholeRows } from "./renderer.js";
import { pick } from "./pick.js";
import { Labels } from "./labels.js";
import { Panel, element } from "./panel.js";
import { listen } from "./controls.js";

const FADED = 130;             // of 255: how much of an image's colour is left
const SLOW = 45, FAST = 22;    // ms a frame while it moves: fewer pixels, or more
const LEAST_SCALE = 0.4;
const MOST_PIXELS = 4.5e6;     // of a picture at rest
const REST = 160;              // ms without a move
const SETTLED = 1000;          // ms until whatever shows the page has surely begun to
const HIDING = 2;              // mean diameters of spheres hide what is behind them
const OVERLAP = 1e-3;          // of a radius: more than this is seen
const QUICK = 120, LAZY = 350; // ms of the first picture: below, a better one is drawn at rest; above, less in a move

export class View {
  constructor(frame, json) {
    this.frame = frame;
    this.data = decode(json);
    const { data } = this;
    this.camera = new Camera(data.flat, data.eye);
    this.walls = wallsOf(data.domain, data.flat);
    this.state = { column: data.columns[0], cutAxis: -1, cutShare: 0.5, flipped: false, walls: true, lines: true,
                   images: false, selected: -1, selectedGroup: 0 };
    this.cut = new Float32Array(4);
    this.images = null;
    this.moving = false;
    this.pace = { scale: 1, rings: 2, last: 0, average: 0, shell: false, still: 1 };
    this.frames = 0;
    this.measureBounds();

    this.stage = element("div", { className: "bernal-stage" });
    this.canvas = element("canvas", { tabIndex: 0, aria: {
      label: `${data.count} ${data.noun}s in a ${data.domain.name}. Arrow keys turn, question mark lists all keys.` } });
    this.canvas.setAttribute("role", "application");
    this.stage.append(this.canvas);
    frame.append(this.stage);
    this.renderer = new Renderer(this.canvas, this.anyOverlap());
    this.order = new Order(data, this.center, this.radiusAlone);
    this.whole = document.documentElement.classList.contains("bernal-page");
    const act = this.actions();
    this.panel = new Panel(frame, this.stage, data, this.state, act);
    this.labels = new Labels(this.stage, data);
    listen(this.canvas, this.whole, act);
    this.upload();
    this.writeCut();
    this.readTheme();

    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", () => this.readTheme());
    new MutationObserver(() => this.readTheme()).observe(document.documentElement, { attributeFilter: ["class"] });
    this.canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.lost = true;
      this.panel.note.textContent = "the graphics processor is away; the view comes back with it";
    });
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.lost = false;
      this.panel.note.textContent = "";
      this.panel.writeNote();
      this.renderer.make();
      this.upload();
      this.changed();
    });
    this.fitted = false;
    new ResizeObserver(() => this.resize()).observe(this.stage);
    // What is drawn before the view is seen may be lost.
    new IntersectionObserver(() => this.rest()).observe(this.stage);
    this.resize();
  }

  get radius() { return this.state.images ? this.radiusWithImages : this.radiusAlone; }

  measureBounds() {
    const { data, camera } = this;
    const lower = [...data.domain.lower], upper = [...data.domain.upper];
    const s = data.spheres;
    for (let k = 0; k < s.length; k += 4)
      for (let axis = 0; axis < (data.flat ? 2 : 3); ++axis) {
        lower[axis] = Math.min(lower[axis], s[k + axis] - s[k + 3]);
        upper[axis] = Math.max(upper[axis], s[k + axis] + s[k + 3]);
      }
    // What lies far out, as an imported packing may have it, does not make the rest small.
    const size = Math.max(...data.domain.upper.map((u, k) => u - data.domain.lower[k]));
    this.lower = lower.map((x, k) => Math.max(x, data.domain.lower[k] - size));
    this.upper = upper.map((x, k) => Math.min(x, data.domain.upper[k] + size));
    this.center = this.lower.map((x, k) => 0.5 * (x + this.upper[k]));
    const far = Math.max(...lower.map((x, k) => Math.max(this.center[k] - x, upper[k] - this.center[k])));
    this.radiusAlone = Math.sqrt(3) * far;
    this.radiusWithImages = this.radiusAlone + 2 * size;
  }

  // Gives the graphics processor all it needs.
  upload() {
    const { data, state } = this;
    this.scale = scaleOf(state.column);
    this.bytes ||= new Uint8Array(4 * data.shown);
    colourBytes(state.column, this.scale, data.palette, this.bytes);
    this.order.count = -1;
    this.renderer.setSpheres(0, this.order.spheres, this.order.bytes, 0);
    this.renderer.setWalls(this.walls);
    if (this.images) this.uploadImages();
    if (data.shells) this.renderer.setShells(data.shells);
    if (data.shown > 0) this.panel.writeKey(state.column, this.scale);
  }
  uploadImages() {
    const count = this.images.rows.length, whole = new Float32Array(4 * wholeRows(count));
    whole.set(this.images.spheres);
    this.renderer.setSpheres(1, whole, this.imageColours(), count);
  }
  // Nearest first, as the eye looks now; where only a quick picture is wanted without what is hidden anyway.
  sortSpheres() {
    const { data, order, pace } = this;
    const quick = this.moving && pace.shell && this.state.cutAxis < 0 && !data.flat;
    const depth = quick ? 2 * HIDING * data.meanRadius : Infinity;
    if (order.serves(this.camera.eye, depth)) return;
    order.sort(this.camera.eye, depth);
    order.colour(this.bytes);
    this.renderer.setSpheres(0, order.spheres, order.bytes, order.count);
  }
  anyOverlap() {
    const { columns } = this.data;
    const gap = columns.find((c) => c.key === "gap"), radius = columns.find((c) => c.key === "radius");
    return Boolean(gap) && gap.values.some((v, k) => v < -OVERLAP * radius.values[k]);
  }
  imageColours() {
    const bytes = new Uint8Array(4 * wholeRows(this.images.rows.length));
    this.images.rows.forEach((row, k) => {
      for (let c = 0; c < 3; ++c) bytes[4 * k + c] = this.bytes[4 * row + c];
      bytes[4 * k + 3] = FADED;
    });
    return bytes;
  }

  colourBy(key) {
    this.state.column = this.data.columns.find((c) => c.key === key);
    this.scale = scaleOf(this.state.column);
    colourBytes(this.state.column, this.scale, this.data.palette, this.bytes);
    this.order.count = -1;
    if (this.images) this.uploadImages();
    this.panel.writeKey(this.state.column, this.scale);
    this.changed();
  }

  show(key, on) {
    const { state, data } = this;
    if (!(key in this.panel.ticks)) return;
    const was = state[key];
    state[key] = on;
    this.panel.ticks[key].checked = on;
    if (key === "images") {
      if (on && !this.images) {
        this.images = imagesOf(data);
        this.uploadImages();
      }
      if (!on && state.selectedGroup === 1) this.select(null);
      const size = Math.max(...data.domain.periods);
      const wider = 1 + (2 * this.images.margin) / size;
      if (on !== was) this.camera.zoom(on ? 1 / wider : wider);
    }
    this.changed();
  }

  // Sets the plane (n, d): n.p > d is taken away. A flat view is the cut through the middles of the discs.
  writeCut() {
    const { cut, state, data } = this;
    cut.fill(0);
    let text = "";
    if (data.flat) {
      cut[2] = 1;
    } else if (state.cutAxis >= 0) {
      const axis = state.cutAxis, sign = state.flipped ? -1 : 1;
      const at = this.lower[axis] + state.cutShare * (this.upper[axis] - this.lower[axis]);
      cut[axis] = sign;
      cut[3] = sign * at;
      const value = data.origin[axis] + data.scale * at;
      const step = 0.001 * data.scale * (this.upper[axis] - this.lower[axis]);
      const digits = Math.max(3, Math.ceil(Math.log10(Math.max(Math.abs(value), step) / step)) + 1);
      text = `${"xyz"[axis]} = ${Number(value.toPrecision(Math.min(15, digits)))} ${data.unit}`.replace("-", "\u2212");
    }
    this.panel.writeCut(state.cutAxis, state.cutShare, text);
  }
  cutAcross(axis) {
    const { state } = this;
    state.cutAxis = axis;
    if (axis >= 0) state.flipped = this.camera.eye[axis] < 0;  // what is nearer is taken away
    this.writeCut();
    this.changed();
  }

  groups() {
    return this.state.images && this.images ? [this.data.spheres, this.images.spheres] : [this.data.spheres];
  }
  // The sphere seen at a place of the window, as {row, group, index} or null.
  pickAt(clientX, clientY) {
    const { x, y } = this.place(clientX, clientY);
    const found = pick(this.camera, x, y, this.groups(), this.cut);
    if (!found) return null;
    const row = found.group === 1 ? this.images.rows[found.row] : found.row;
    return { ...found, sphere: row, index: this.data.indices[row] };
  }
  select(found) {
    const { state, panel } = this;
    state.selected = found ? found.row : -1;
    state.selectedGroup = found ? found.group : 0;
    if (found) panel.writeCard(found.sphere, found.group === 1, () => { this.select(null); this.canvas.focus(); });
    else panel.closeCard();
    this.changed();
  }

  place(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect();
    return { x: (2 * (clientX - box.left)) / box.width - 1, y: 1 - (2 * (clientY - box.top)) / box.height };
  }

  actions() {
    const { data, state, camera } = this;
    const moved = () => this.move();
    return {
      flat: data.flat,
      hasWalls: this.walls.triangles.length > 0,
      hasImages: data.shown > 0 && Math.max(...data.domain.periods) > 0,
      colourBy: (key) => this.colourBy(key),
      nextColour: () => {
        const next = (data.columns.indexOf(state.column) + 1) % data.columns.length;
        if (data.shown > 0) this.colourBy(data.columns[next].key);
      },
      cutAcross: (axis) => this.cutAcross(axis),
      nextCut: () => { if (!data.flat) this.cutAcross(state.cutAxis >= 2 ? -1 : state.cutAxis + 1); },
      cutAt: (share) => { state.cutShare = share; this.writeCut(); moved(); this.rest(); },
      moveCut: (by) => {
        if (state.cutAxis < 0) return;
        state.cutShare = Math.min(1, Math.max(0, state.cutShare + by));
        this.writeCut();
        moved();
      },
      flip: () => { state.flipped = !state.flipped; this.writeCut(); this.changed(); },
      show: (key, on) => this.show(key, on),
      toggle: (key) => this.show(key, !state[key]),
      turn: (by, rise) => { camera.turn(by, rise); moved(); },
      pan: (dx, dy) => { camera.pan(dx / this.canvas.clientHeight, -dy / this.canvas.clientHeight); moved(); },
      zoom: (factor, at = { x: 0, y: 0 }) => { camera.zoom(factor, at.x, at.y); moved(); },
      lookAlong: (axis) => {
        camera.turnTo(axis === 0 ? 0 : -Math.PI / 2, axis === 2 ? Math.PI / 2 : 0);
        this.changed();
      },
      reset: () => { camera.reset(this.lower, this.upper); this.changed(); },
      picture: () => this.savePicture(),
      wholeScreen: () => {
        if (document.fullscreenElement) document.exitFullscreen();
        else if (document.fullscreenEnabled) this.frame.requestFullscreen();
      },
      keys: () => this.panel.toggleKeys(),
      escape: () => {
        if (!this.panel.keys.hidden) this.panel.toggleKeys(false);
        else if (state.selected >= 0) this.select(null);
        else this.canvas.blur();
      },
      click: (event) => this.select(this.pickAt(event.clientX, event.clientY)),
      place: (x, y) => this.place(x, y),
      rest: () => this.rest(),
    };
  }

  savePicture() {
    this.drawNow(1);
    this.canvas.toBlob((blob) => {
      const link = element("a", { download: "packing.png" });
      link.href = URL.createObjectURL(blob);
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    });
  }

  // Colours of the page, which CSS chooses.
  readTheme() {
    const style = getComputedStyle(this.frame);
    const read = (name) => {
      const hex = style.getPropertyValue(name).trim();
      return Float32Array.from([1, 3, 5], (k) => parseInt(hex.slice(k, k + 2), 16) / 255);
    };
    this.theme = { background: read("--bernal-ground"), line: read("--bernal-line"), accent: read("--bernal-accent") };
    this.changed();
  }

  resize() {
    const { clientWidth, clientHeight } = this.stage;
    if (clientWidth === 0 || clientHeight === 0) return;
    const density = Math.min(window.devicePixelRatio || 1, 3);
    const width = Math.round(clientWidth * density), height = Math.round(clientHeight * density);
    if (width === this.canvas.width && height === this.canvas.height && this.fitted) return;
    Object.assign(this.canvas, { width, height });  // which empties it
    this.camera.aspect = clientWidth / clientHeight;
    if (!this.fitted) this.camera.reset(this.lower, this.upper);
    this.fitted = true;
    if (this.frames > 0) this.onFrame(performance.now());  // at once: an empty picture is not to be seen
    else this.changed();
  }

  // A choice was made: one good picture. A move: pictures as fast as they come, then a good one.
  changed() {
    if (!this.asked) this.asked = requestAnimationFrame((now) => this.onFrame(now));
  }
  move() {
    if (!this.moving) this.pace.last = 0;
    this.moving = true;
    this.lastMove = performance.now();
    this.changed();
  }
  rest() {
    clearTimeout(this.resting);
    this.resting = setTimeout(() => { this.moving = false; this.changed(); }, REST);
  }

  onFrame(now) {
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    if (this.lost) return;
    if (this.moving) this.keepPace(now);
    if (this.frames === 0) this.drawFirst();
    else this.drawNow(this.moving ? this.pace.scale : this.scaleAtRest());
    this.labels.update(this.camera, this.canvas.clientHeight);
  }
  // Finds out how fast this machine draws, once.
  drawFirst() {
    const { gl } = this.renderer, { pace } = this;
    const start = performance.now();
    this.drawNow(1);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));  // which waits
    const spent = performance.now() - start;
    if (spent > LAZY) Object.assign(pace, { rings: 0, shell: true, scale: 0.5 });
    if (spent <= QUICK) pace.still = 2;
    this.changed();
    setTimeout(() => this.changed(), SETTLED);
  }
  // Fewer pixels and less shading where frames come slowly.
  keepPace(now) {
    const { pace } = this;
    const spent = now - pace.last;
    if (pace.last > 0 && spent < 1000) {
      pace.average = pace.average ? 0.7 * pace.average + 0.3 * spent : spent;
      if (pace.average > SLOW) {
        if (pace.rings > 0) pace.rings = 0;
        else if (!pace.shell) pace.shell = true;
        else pace.scale = Math.max(LEAST_SCALE, 0.8 * pace.scale);
        pace.average = 0;
      } else if (pace.average < FAST && pace.scale < 1) {
        pace.scale = Math.min(1, 1.1 * pace.scale);
        pace.average = 0;
      }
    }
    pace.last = now;
  }
  scaleAtRest() {
    const pixels = this.canvas.width * this.canvas.height;
    const wanted = (window.devicePixelRatio || 1) > 1.5 ? 1 : this.pace.still;
    return Math.min(wanted, Math.sqrt(MOST_PIXELS / pixels));
  }
  drawNow(scale) {
    const { camera, cut, theme, state, data } = this;
    const canvas = this.canvas;
    const shape = (this.shape ||= {});
    this.sortSpheres();
    const selected = state.selectedGroup === 1 || state.selected < 0 ? state.selected
      : this.order.placeOf(state.selected);
    Object.assign(shape, {
      camera, cut, theme, scale, radius: this.radius, center: this.center, selected,
      selectedGroup: state.selectedGroup, images: state.images, walls: state.walls,
      lines: state.lines, rings: this.moving ? this.pace.rings : 3, meanRadius: data.meanRadius, flat: data.flat,
      density: canvas.width / Math.max(1, canvas.clientWidth),
    });
    this.renderer.draw(shape);
    ++this.frames;
  }
}

function start() {
  const frames = document.querySelectorAll(".bernal-view"), texts = document.querySelectorAll(".bernal-data");
  frames.forEach((frame, k) => {
    try {
      frame.bernal = new View(frame, JSON.parse(texts[k].textContent));
    } catch (problem) {
      console.warn("no view: " + problem.message);
      frame.replaceChildren();
      frame.hidden = true;
    }
  });
}
start();
