// Spheres in the order in which they are drawn: nearest first, so that what is hidden behind them is not drawn at all.

import { wholeRows } from "./renderer.js";

const LAYERS = 2048;
const LIKE = Math.cos(Math.PI / 15);  // eyes that see nearly the same order

export class Order {
  constructor(data, center, radius) {
    Object.assign(this, { data, center, radius });
    const n = data.shown;
    this.layer = new Uint16Array(n);
    this.start = new Uint32Array(LAYERS + 1);
    this.rows = new Uint32Array(n);  // by place in the order
    this.spheres = new Float32Array(4 * wholeRows(n));
    this.bytes = new Uint8Array(4 * wholeRows(n));
    this.eye = new Float32Array(3);
    this.count = -1;
  }

  // Whether it still serves an eye, and spheres down to a depth.
  serves(eye, depth) {
    const { eye: own } = this;
    return this.count >= 0 && this.depth === depth && own[0] * eye[0] + own[1] * eye[1] + own[2] * eye[2] > LIKE;
  }

  // Cost: O(spheres); nothing is made. Those deeper than `depth` are left out: see `decode`.
  sort(eye, depth) {
    const { data, layer, start, rows, center } = this;
    const s = data.spheres, n = data.shown, perLayer = (0.999 * LAYERS) / (2 * this.radius);
    const middle = center[0] * eye[0] + center[1] * eye[1] + center[2] * eye[2];
    start.fill(0);
    for (let k = 0; k < n && data.depths[k] <= depth; ++k) {
      const height = s[4 * k] * eye[0] + s[4 * k + 1] * eye[1] + s[4 * k + 2] * eye[2] - middle;
      layer[k] = Math.min(LAYERS - 1, Math.max(0, (this.radius - height) * perLayer));
      ++start[layer[k] + 1];
    }
    for (let k = 1; k <= LAYERS; ++k) start[k] += start[k - 1];
    this.count = start[LAYERS];
    for (let k = 0; k < this.count; ++k) rows[start[layer[k]]++] = k;
    for (let at = 0; at < this.count; ++at) {
      const row = 4 * rows[at];
      for (let c = 0; c < 4; ++c) this.spheres[4 * at + c] = s[row + c];
    }
    this.eye.set(eye);
    this.depth = depth;
  }
  colour(bytes) {
    for (let at = 0; at < this.count; ++at) {
      const row = 4 * this.rows[at];
      for (let c = 0; c < 4; ++c) this.bytes[4 * at + c] = bytes[row + c];
    }
  }
  placeOf(row) {
    for (let at = 0; at < this.count; ++at) if (this.rows[at] === row) return at;
    return -1;
  }
}
