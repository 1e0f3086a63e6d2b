// An orthographic camera on a turntable: +z stays up. In a flat view it looks down and does not turn.

const STEEPEST = Math.PI / 2;

export class Camera {
  constructor(flat, eye) {
    this.flat = flat;
    this.first = { azimuth: Math.atan2(eye[1], eye[0]), elevation: Math.asin(eye[2]) };
    this.right = new Float32Array(3);
    this.up = new Float32Array(3);
    this.eye = new Float32Array(3);  // from the scene to whoever looks
    this.target = new Float32Array(3);
    this.half = 1;  // of the height that is seen
    this.aspect = 1;
    this.turnTo(this.first.azimuth, this.first.elevation);
  }

  turnTo(azimuth, elevation) {
    this.azimuth = this.flat ? -Math.PI / 2 : azimuth;
    this.elevation = this.flat ? STEEPEST : Math.min(STEEPEST, Math.max(-STEEPEST, elevation));
    const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth);
    const ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
    this.right.set([-sa, ca, 0]);
    this.up.set([-se * ca, -se * sa, ce]);
    this.eye.set([ce * ca, ce * sa, se]);
  }
  turn(by, rise) {
    this.turnTo(this.azimuth + by, this.elevation + rise);
  }

  // By shares of the height that is seen.
  pan(x, y) {
    for (let k = 0; k < 3; ++k) this.target[k] -= 2 * this.half * (x * this.right[k] + y * this.up[k]);
  }

  // Nearer by a factor; what is at (x, y), in [-1, 1] from the middle, stays there.
  zoom(factor, x = 0, y = 0) {
    const half = Math.min(this.farthest, Math.max(this.nearest, this.half / factor));
    for (let k = 0; k < 3; ++k)
      this.target[k] += (this.half - half) * (x * this.aspect * this.right[k] + y * this.up[k]);
    this.half = half;
  }

  // Shows all of a box; `margin` is the share of the window left free.
  fit(lower, upper, margin = 0.08) {
    const extent = [0, 0];
    for (let k = 0; k < 3; ++k) {
      const size = 0.5 * (upper[k] - lower[k]);
      this.target[k] = 0.5 * (lower[k] + upper[k]);
      extent[0] += size * Math.abs(this.right[k]);
      extent[1] += size * Math.abs(this.up[k]);
    }
    this.half = Math.max(extent[1], extent[0] / this.aspect, 1e-6) / (1 - margin);
    this.farthest = 20 * this.half;
    this.nearest = this.half / 2000;
  }
  reset(lower, upper) {
    this.turnTo(this.first.azimuth, this.first.elevation);
    this.fit(lower, upper);
  }

  // The point of the plane through the target that is seen at (x, y), in [-1, 1] from the middle.
  pointAt(x, y, out) {
    for (let k = 0; k < 3; ++k)
      out[k] = this.target[k] + this.half * (x * this.aspect * this.right[k] + y * this.up[k]);
    return out;
  }
}
