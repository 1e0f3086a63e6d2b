// The images of spheres in the neighbouring periods, as many as can be drawn.

const MOST = 150000;

// {spheres: x, y, z, r; rows: whose image each is; margin: how far beyond the box centres lie}.
export function imagesOf(data) {
  const { spheres, domain, meanRadius } = data;
  const n = spheres.length / 4;
  const steps = domain.periods.map((period) => (period > 0 ? [-1, 0, 1] : [0]));
  const size = Math.max(...domain.periods);
  const isNear = (x, axis, margin) =>
    !(domain.periods[axis] > 0) || (x >= domain.lower[axis] - margin && x <= domain.upper[axis] + margin);
  const collect = (margin) => {
    const found = [], rows = [];
    for (const i of steps[0]) for (const j of steps[1]) for (const k of steps[2]) {
      if (i === 0 && j === 0 && k === 0) continue;
      const shift = [i * domain.periods[0], j * domain.periods[1], k * domain.periods[2]];
      for (let row = 0; row < n; ++row) {
        const x = spheres[4 * row] + shift[0], y = spheres[4 * row + 1] + shift[1],
          z = spheres[4 * row + 2] + shift[2];
        if (!isNear(x, 0, margin) || !isNear(y, 1, margin) || !isNear(z, 2, margin)) continue;
        found.push(x, y, z, spheres[4 * row + 3]);
        rows.push(row);
      }
      if (rows.length > MOST) return null;
    }
    return { spheres: Float32Array.from(found), rows: Uint32Array.from(rows), margin };
  };
  for (let margin = 0.5 * size; ; margin /= 2) {
    const images = collect(margin);
    if (images) return images;
    if (margin < meanRadius) return { spheres: new Float32Array(0), rows: new Uint32Array(0), margin: 0 };
  }
}
