// The scale bar and the axes, beside the picture.

import { numberText } from "./colours.js";

const SVG = "http:" + "//www.w3.org/2000/svg";

export function svgElement(name, attributes = {}, parent = null) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (parent) parent.append(element);
  return element;
}

// The largest 1, 2 or 5 times a power of ten that is at most `length`.
function roundLength(length) {
  const decade = 10 ** Math.floor(Math.log10(length));
  for (const step of [5, 2]) if (step * decade <= length) return step * decade;
  return decade;
}

export class Labels {
  constructor(frame, data) {
    this.data = data;
    this.svg = svgElement("svg", { class: "bernal-labels", "aria-hidden": "true", width: 190, height: 92 }, frame);
    this.bar = svgElement("path", { class: "bernal-bar" }, this.svg);
    this.length = svgElement("text", { x: 184, y: 76, "text-anchor": "end" }, this.svg);
    this.axes = ["x", "y", "z"].slice(0, data.flat ? 2 : 3).map((name) => {
      const line = svgElement("line", { class: "bernal-axis" }, this.svg);
      const text = svgElement("text", { "text-anchor": "middle" }, this.svg);
      text.textContent = name;
      return { line, text };
    });
  }

  update(camera, height) {
    const size = 24, middle = [150, 36];
    this.axes.forEach(({ line, text }, k) => {
      const x = camera.right[k], y = -camera.up[k];
      line.setAttribute("x1", middle[0]);
      line.setAttribute("y1", middle[1]);
      line.setAttribute("x2", middle[0] + size * x);
      line.setAttribute("y2", middle[1] + size * y);
      line.setAttribute("opacity", camera.eye[k] < -0.3 ? 0.45 : 1);
      const shown = Math.hypot(x, y) > 0.15 ? 1 : 0;
      text.setAttribute("x", middle[0] + (size + 8) * x);
      text.setAttribute("y", middle[1] + (size + 8) * y + 4);
      text.setAttribute("opacity", shown);
    });
    const unit = (2 * camera.half * this.data.scale) / height;  // of the scene, a pixel
    const length = roundLength(110 * unit), pixels = length / unit;
    this.bar.setAttribute("d", `M${184 - pixels} 82v6h${pixels}v-6`);
    const text = `${numberText(length, 3)} ${this.data.unit}`;
    if (this.length.textContent !== text) this.length.textContent = text;
  }
}
