// The container as triangles and lines.

const AROUND = 96;

function across(axis) {
  const k = Math.abs(axis[0]) < 0.6 ? 0 : 1, other = [k === 0 ? 1 : 0, k === 1 ? 1 : 0, 0];
  const u = cross(axis, other), length = Math.hypot(...u);
  const unit = u.map((x) => x / length);
  return [unit, cross(axis, unit)];
}
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function boxOf(lower, upper, flat) {
  const corners = [], lines = [];
  for (let c = 0; c < 8; ++c) corners.push([0, 1, 2].map((k) => ((c >> k) & 1 ? upper[k] : lower[k])));
  for (let a = 0; a < 8; ++a)
    for (let k = 0; k < (flat ? 2 : 3); ++k) {
      if ((a >> k) & 1 || (flat && a > 3)) continue;
      lines.push(...corners[a], ...corners[a | (1 << k)]);
    }
  const faces = flat ? [] : [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
                             1, 3, 5, 3, 7, 5];
  return { vertices: corners.flat(), triangles: faces, lines };
}

function cylinderOf({ base, axis, radius, height, periods }) {
  const [u, v] = across(axis), open = Math.max(...periods) > 0;
  const vertices = [], triangles = [], lines = [];
  const ring = (k, h) => {
    const c = radius * Math.cos((2 * Math.PI * k) / AROUND), s = radius * Math.sin((2 * Math.PI * k) / AROUND);
    return [0, 1, 2].map((i) => base[i] + h * axis[i] + c * u[i] + s * v[i]);
  };
  for (let k = 0; k < AROUND; ++k) vertices.push(...ring(k, 0), ...ring(k, height));
  vertices.push(...base, ...[0, 1, 2].map((i) => base[i] + height * axis[i]));
  for (let k = 0; k < AROUND; ++k) {
    const a = 2 * k, b = 2 * ((k + 1) % AROUND);
    triangles.push(a, b, a + 1, b, b + 1, a + 1);
    if (!open) triangles.push(2 * AROUND, b, a, 2 * AROUND + 1, a + 1, b + 1);
    lines.push(...ring(k, 0), ...ring(k + 1, 0), ...ring(k, height), ...ring(k + 1, height));
  }
  return { vertices, triangles, lines };
}

function sphereOf({ center, radius }) {
  const rows = AROUND / 2, vertices = [], triangles = [], lines = [];
  for (let i = 0; i <= rows; ++i)
    for (let k = 0; k < AROUND; ++k) {
      const t = (Math.PI * i) / rows, p = (2 * Math.PI * k) / AROUND;
      vertices.push(center[0] + radius * Math.sin(t) * Math.cos(p), center[1] + radius * Math.sin(t) * Math.sin(p),
                    center[2] + radius * Math.cos(t));
    }
  for (let i = 0; i < rows; ++i)
    for (let k = 0; k < AROUND; ++k) {
      const a = i * AROUND + k, b = i * AROUND + ((k + 1) % AROUND);
      triangles.push(a, a + AROUND, b, b, a + AROUND, b + AROUND);
    }
  return { vertices, triangles, lines };
}

// Typed arrays: three numbers a vertex, three indices a triangle, six numbers a line; and the box around it all.
export function wallsOf(domain, flat) {
  const make = { box: () => boxOf(domain.lower, domain.upper, flat), cylinder: () => cylinderOf(domain),
                 sphere: () => sphereOf(domain) }[domain.kind];
  const shape = make ? make() : { vertices: domain.vertices || [], triangles: domain.triangles || [],
                                  lines: domain.edges };
  const surface = domain.walls && !flat ? shape : { vertices: [], triangles: [] };
  return { vertices: Float32Array.from(surface.vertices), triangles: Uint32Array.from(surface.triangles),
           lines: Float32Array.from(shape.lines) };
}
