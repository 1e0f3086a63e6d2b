// Which sphere is seen at a place: along the line of sight the first surface, or the face of the cut.

const origin = new Float64Array(3);

// `groups` are arrays of x, y, z, r; answers {group, row} or null. `cut` is (n, d), see sphere.frag.
export function pick(camera, x, y, groups, cut) {
  camera.pointAt(x, y, origin);
  const e = camera.eye, slope = cut[0] * e[0] + cut[1] * e[1] + cut[2] * e[2];
  const offset = cut[3] - (cut[0] * origin[0] + cut[1] * origin[1] + cut[2] * origin[2]);
  const isCut = cut[0] !== 0 || cut[1] !== 0 || cut[2] !== 0;
  let found = null, nearest = -Infinity;
  for (let group = 0; group < groups.length; ++group) {
    const s = groups[group];
    for (let k = 0; k < s.length; k += 4) {
      const dx = s[k] - origin[0], dy = s[k + 1] - origin[1], dz = s[k + 2] - origin[2];
      const height = dx * e[0] + dy * e[1] + dz * e[2];
      const squared = s[k + 3] * s[k + 3] - (dx * dx + dy * dy + dz * dz - height * height);
      if (!(squared > 0)) continue;
      const half = Math.sqrt(squared);
      let at = height + half;
      if (isCut && at * slope > offset) {
        at = offset / slope;
        if (!(slope > 0 && at >= height - half && at <= height + half)) continue;
      }
      if (at > nearest) [nearest, found] = [at, { group, row: k / 4 }];
    }
  }
  return found;
}
