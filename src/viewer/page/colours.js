// From a column of numbers to colours, and what the key says of it.

// Okabe & Ito's, which all kinds of colour vision tell apart; grey is for none.
const CATEGORIES = ["#9aa4ae", "#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7"];
const NONE = CATEGORIES[0];

const channels = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));

function quantile(sorted, share) {
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}

// As few digits as tell numbers this near to each other apart.
export function numberText(value, digits = 4) {
  if (!Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(Math.min(3, digits - 1)).split("e");
    const superscripts = String(Number(exponent)).replace(/[-0-9]/g, (c) =>
      c === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[c]);
    return (Number(mantissa) + "\u00d710" + superscripts).replace("-", "\u2212");
  }
  return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

// The scale of a column: {at(value) in [0, 1], NaN for none}, its ends, and whether values beyond them exist.
export function scaleOf(column) {
  const sorted = Float32Array.from(column.values.filter((v) => Number.isFinite(v))).sort();
  const scale = { kind: column.kind, low: 0, high: 1, below: false, above: false, logarithmic: false };
  if (sorted.length === 0) return { ...scale, empty: true, at: () => NaN };
  const least = sorted[0], most = sorted[sorted.length - 1];
  scale.low = least;
  scale.high = most;
  if (column.kind === "category") return { ...scale, at: (v) => v };
  if (column.key === "gap") scale.high = Math.max(quantile(sorted, 0.98), 0);
  if (column.key === "gap" || column.key === "wall") scale.low = Math.min(0, quantile(sorted, 0.02));
  if (column.kind === "number") {
    scale.low = quantile(sorted, 0.01);
    scale.high = quantile(sorted, 0.99);
  }
  if (!(scale.high > scale.low)) [scale.low, scale.high] = [least, most];
  scale.below = least < scale.low;
  scale.above = most > scale.high;
  scale.logarithmic = column.key === "radius";
  const equal = column.kind === "count" ? most === least : !(most - least > 1e-3 * Math.abs(most));
  if (equal) return { ...scale, low: least, high: most, equal, at: (v) => (Number.isFinite(v) ? 0.5 : NaN) };
  const map = scale.logarithmic ? Math.log : (v) => v;
  const from = map(scale.low), width = map(scale.high) - from;
  scale.middle = scale.logarithmic ? Math.sqrt(scale.low * scale.high) : 0.5 * (scale.low + scale.high);
  return { ...scale, at: (v) => Math.min(1, Math.max(0, (map(v) - from) / width)) };
}

export function categoryColour(category) {
  return category === 0 ? NONE : CATEGORIES[1 + ((category - 1) % (CATEGORIES.length - 1))];
}

export function colourAt(palette, t) {
  if (!Number.isFinite(t)) return NONE;
  const k = Math.min(palette.length - 1, Math.round(t * (palette.length - 1)));
  return palette[k];
}

// Four bytes a sphere.
export function colourBytes(column, scale, palette, bytes) {
  const cache = new Map();
  for (let k = 0; k < column.values.length; ++k) {
    const t = scale.at(column.values[k]);
    const hex = scale.kind === "category" ? categoryColour(t) : colourAt(palette, t);
    let rgb = cache.get(hex);
    if (!rgb) cache.set(hex, (rgb = channels(hex)));
    bytes.set(rgb, 4 * k);
    bytes[4 * k + 3] = 255;
  }
}
