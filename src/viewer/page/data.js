// What a page has of a packing, as typed arrays. Lengths are local: scene = origin + scale * local.

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let k = 0; k < bytes.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}
const floats = (base64) => new Float32Array(bytesOf(base64).buffer);
const words = (base64) => new Uint32Array(bytesOf(base64).buffer);
const counts = (base64) => new Uint16Array(bytesOf(base64).buffer);

// How far each sphere is from what hides the inside: the walls, or the ends of the periods.
function depthsOf(spheres, domain, wall, scale) {
  const depths = new Float32Array(spheres.length / 4);
  for (let k = 0; k < depths.length; ++k) {
    let depth = wall ? wall.values[k] / scale : Infinity;
    for (let axis = 0; axis < 3; ++axis) {
      if (!(domain.periods[axis] > 0)) continue;
      const x = spheres[4 * k + axis], r = spheres[4 * k + 3];
      depth = Math.min(depth, x - r - domain.lower[axis], domain.upper[axis] - x - r);
    }
    depths[k] = depth;
  }
  return depths;
}

function reordered(values, order, width) {
  const out = new values.constructor(values.length);
  for (let k = 0; k < order.length; ++k)
    for (let w = 0; w < width; ++w) out[width * k + w] = values[width * order[k] + w];
  return out;
}

// The balls in which layers end, from the centre out, with the colours that a cut shows; null where there are none.
function shellsOf(json, spheres) {
  if (!json.layers) return null;
  const number = counts(json.layers.counts), radii = floats(json.layers.radii), kinds = counts(json.layers.kinds);
  const balls = new Float32Array(4 * radii.length), tints = new Uint8Array(4 * radii.length);
  const colours = json.layers.colours.map((hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16)));
  let at = 0;
  for (let k = 0; k < number.length; ++k)
    for (let layer = 0; layer < number[k]; ++layer, ++at) {
      balls.set(spheres.subarray(4 * k, 4 * k + 3), 4 * at);
      balls[4 * at + 3] = radii[at];
      tints.set([...colours[kinds[at]], 255], 4 * at);
    }
  return { balls, tints, count: radii.length, names: json.layers.names, colours: json.layers.colours };
}

// Spheres come outermost first: what hides the others is drawn before them.
export function decode(json) {
  const flat = json.dimension === 2, n = json.shown;
  const centers = floats(json.spheres.centers), radii = json.spheres.radii;
  const each = typeof radii === "string" ? floats(radii) : null;
  let spheres = new Float32Array(4 * n);
  for (let k = 0; k < n; ++k) {
    for (let axis = 0; axis < json.dimension; ++axis)
      spheres[4 * k + axis] = centers[json.dimension * k + axis];
    spheres[4 * k + 3] = each ? each[k] : radii;
  }
  const shells = shellsOf(json, spheres);
  const columns = json.columns.map((column) => ({
    key: column.key, title: column.title, kind: column.kind,
    values: column.kind === "count" || column.kind === "category" ? counts(column.values) : floats(column.values),
  }));
  const size = new Float32Array(n);
  for (let k = 0; k < n; ++k) size[k] = spheres[4 * k + 3] * json.scale;
  columns.unshift({ key: "radius", title: "radius", kind: "length", values: size });

  const depths = depthsOf(spheres, json.domain, columns.find((c) => c.key === "wall"), json.scale);
  const order = Uint32Array.from(depths.keys()).sort((a, b) => depths[a] - depths[b]);
  spheres = reordered(spheres, order, 4);
  for (const column of columns) column.values = reordered(column.values, order, 1);
  const indices = json.spheres.indices ? reordered(words(json.spheres.indices), order, 1) : order;

  const domain = { ...json.domain };
  for (const [key, read] of [["vertices", floats], ["triangles", words], ["edges", floats]])
    if (domain[key] !== undefined) domain[key] = read(domain[key]);
  let sum = 0;
  for (let k = 0; k < n; ++k) sum += spheres[4 * k + 3];
  return {
    flat, count: json.count, shown: n, unit: json.unit, origin: json.origin, scale: json.scale, eye: json.eye,
    palette: json.palette, domain, spheres, columns, shells, indices, depths: reordered(depths, order, 1),
    noun: json.dimension === 2 ? "disc" : "sphere", shellDepth: json.spheres.depth || 0, meanRadius: n > 0 ? sum / n : 0,
  };
}
