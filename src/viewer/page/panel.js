// What stands around the picture: the bar of choices, the key of the colours, the card of a sphere, the list of keys.
import { numberText, categoryColour } from "./colours.js";
import { svgElement } from "./labels.js";

const KEYS = [
  ["drag, arrows", "turn", true], ["shift + drag, shift + arrows", "move"], ["wheel, + and \u2212", "nearer, farther"],
  ["click", "numbers of a sphere"], ["m", "colour by the next"], ["c", "cut across the next axis", true],
  ["[ and ]", "move the cut", true], ["f", "other side of the cut", true],
  ["x, y, z", "look along an axis", true], ["i", "periodic images", false, "images"], ["w", "container", true, "walls"],
  ["o", "outline"], ["0", "view of the beginning"], ["p", "save a picture"], ["e", "whole screen, and back"],
  ["Esc", "close, let go"],
];

export function element(name, properties = {}, ...children) {
  const { aria, ...own } = properties;
  const made = Object.assign(document.createElement(name), own);
  for (const [key, value] of Object.entries(aria || {})) made.setAttribute("aria-" + key, value);
  made.append(...children);
  return made;
}

function choice(title, className, options, onchange) {
  const select = element("select", { onchange: () => onchange(select.value) },
    ...options.map(([value, text]) => element("option", { value, textContent: text })));
  return [element("label", { className }, element("span", { textContent: title }), select), select];
}
function tick(title, checked, onchange) {
  const box = element("input", { type: "checkbox", checked, onchange: () => onchange(box.checked) });
  return [element("label", { className: "bernal-tick" }, box, element("span", { textContent: title })), box];
}
function button(text, title, onclick) {
  return element("button", { type: "button", title, onclick, aria: { label: title } }, text);
}
function cornersIcon() {
  const icon = svgElement("svg", { width: 13, height: 13, viewBox: "0 0 13 13", class: "bernal-icon" });
  svgElement("path", { d: "M1 4.5v-3.5h3.5M8.5 1h3.5v3.5M12 8.5v3.5h-3.5M4.5 12h-3.5v-3.5" }, icon);
  return icon;
}

export class Panel {
  // `act` has a function for each thing that can be chosen.
  constructor(frame, stage, data, state, act) {
    this.data = data;
    this.state = state;
    const bar = element("div", { className: "bernal-bar-of-choices", role: "toolbar", aria: { label: "View" } });
    const [colour, colourSelect] = choice("Colour", "bernal-choice", data.columns.map((c) => [c.key, c.title]),
      act.colourBy);
    this.colourSelect = colourSelect;
    if (data.shown > 0) bar.append(colour);
    if (!data.flat) {
      const [cut, cutSelect] = choice("Cut", "bernal-choice",
        [["", "none"], ["0", "across x"], ["1", "across y"], ["2", "across z"]],
        (value) => act.cutAcross(value === "" ? -1 : Number(value)));
      this.cutSelect = cutSelect;
      this.slider = element("input", { type: "range", min: 0, max: 1, step: "any", aria: { label: "Place of the cut" },
        oninput: () => act.cutAt(Number(this.slider.value)) });
      this.flip = button("\u21c4", "Show the other side of the cut (f)", act.flip);
      this.cutValue = element("output", { className: "bernal-value" });
      this.cutGroup = element("span", { className: "bernal-group" }, this.slider, this.flip, this.cutValue);
      bar.append(cut, this.cutGroup);
    }
    const ticks = element("span", { className: "bernal-group" });
    this.ticks = {};
    for (const [key, title, has] of [["walls", "container", act.hasWalls], ["lines", "outline", true],
                                     ["images", "images", act.hasImages]]) {
      if (!has) continue;
      const [label, box] = tick(title, state[key], (on) => act.show(key, on));
      this.ticks[key] = box;
      ticks.append(label);
    }
    const buttons = element("span", { className: "bernal-group bernal-end" },
      button("reset", "View of the beginning (0)", act.reset), button("picture", "Save a picture (p)", act.picture));
    if (document.fullscreenEnabled) buttons.append(button(cornersIcon(), "Whole screen (e)", act.wholeScreen));
    buttons.append(button("?", "Keys (?)", () => this.toggleKeys()));
    bar.append(ticks, buttons);
    frame.append(bar);

    this.key = element("div", { className: "bernal-key" });
    this.note = element("div", { className: "bernal-note" });
    this.card = element("div", { className: "bernal-card", hidden: true, aria: { live: "polite" } });
    this.keys = element("div", { className: "bernal-keys", hidden: true, role: "dialog", aria: { label: "Keys" } },
      element("table", {}, ...KEYS.filter(([, , solid, what]) =>
        !(solid && data.flat) && (!what || what in this.ticks)).map(([key, what]) =>
        element("tr", {}, element("th", { textContent: key }), element("td", { textContent: what })))),
      button("\u00d7", "Close (Esc)", () => this.toggleKeys(false)));
    stage.append(this.key, this.note, this.card, this.keys);
    this.writeNote();
  }

  writeNote() {
    const { data } = this;
    const grouped = (n) => n.toLocaleString("en-US");
    if (data.count === 0) this.note.textContent = `no ${data.noun}s`;
    else if (data.shown < data.count)
      this.note.textContent = `shell of ${grouped(data.count)} ${data.noun}s: the outermost ${grouped(data.shown)}, ` +
        `down to ${numberText(data.shellDepth, 3)} ${data.unit}; deeper ones are left out`;
  }

  toggleKeys(show = this.keys.hidden) {
    this.keys.hidden = !show;
  }

  lengthText(value, kind, digits = 4) {
    return numberText(value, digits) + (kind === "length" && Number.isFinite(value) ? " " + this.data.unit : "");
  }

  writeKey(column, scale) {
    const unit = column.kind === "length" ? ` (${this.data.unit})` : "";
    this.key.replaceChildren(element("b", { textContent: column.title + unit }));
    const swatch = (colour, text) => element("span", { className: "bernal-swatch" },
      Object.assign(element("i"), { style: `background:${colour}` }), text);
    if (scale.empty) {
      this.key.append(element("span", { textContent: "no numbers" }));
    } else if (column.kind === "category") {
      const there = [...new Set(column.values)].sort((a, b) => a - b);
      const shown = there.slice(0, 9);
      this.key.append(element("div", { className: "bernal-swatches" },
        ...shown.map((c) => swatch(categoryColour(c), c === 0 ? "none" : String(c)))));
      if (there.length > shown.length || Math.max(...there) > 7)
        this.key.append(element("small", { textContent: `${there.length} in all; colours repeat` }));
    } else if (scale.equal) {
      this.key.append(swatch(this.data.palette[16], this.lengthText(scale.low, "number") + ", all of them"));
    } else if (column.kind === "count" && scale.high - scale.low <= 16) {
      const steps = [];
      for (let v = scale.low; v <= scale.high; ++v)
        steps.push(swatch(this.data.palette[Math.round(32 * scale.at(v))], String(v)));
      this.key.append(element("div", { className: "bernal-steps" }, ...steps));
    } else {
      const bar = element("div", { className: "bernal-gradient" });
      bar.style.background = `linear-gradient(90deg,${this.data.palette.join(",")})`;
      const text = (value, sign) => element("span", { textContent: sign + numberText(value, 3) });
      this.key.append(bar, element("div", { className: "bernal-ends" },
        text(scale.low, scale.below ? "\u2264 " : ""),
        ...(column.kind === "count" ? [] : [text(scale.middle, "")]),
        text(scale.high, scale.above ? "\u2265 " : "")));
      if (scale.logarithmic) this.key.append(element("small", { textContent: "logarithmic" }));
    }
    if (column.values.some((v) => !Number.isFinite(v)))
      this.key.append(swatch(categoryColour(0), "no number"));
    const { shells } = this.data;
    if (shells)
      this.key.append(element("small", { textContent: "in a cut" }), element("div", { className: "bernal-swatches" },
        ...shells.names.map((name, k) => swatch(shells.colours[k], name))));
    this.colourSelect.value = column.key;
  }

  writeCut(axis, share, text) {
    if (!this.cutSelect) return;
    this.cutSelect.value = axis < 0 ? "" : String(axis);
    this.cutGroup.classList.toggle("bernal-off", axis < 0);
    this.slider.disabled = this.flip.disabled = axis < 0;
    this.slider.value = share;
    this.slider.setAttribute("aria-valuetext", text);
    this.cutValue.textContent = this.cutValue.title = text;
  }

  // `image` says which period, or is null.
  writeCard(row, image, close) {
    const { data } = this;
    const axes = data.flat ? 2 : 3;
    const center = [...Array(axes).keys()].map((k) => data.origin[k] + data.scale * data.spheres[4 * row + k]);
    const digits = data.scale * 2e-7;  // what single precision leaves
    const places = Math.min(12, Math.max(0, Math.ceil(-Math.log10(digits))));
    const rows = center.map((value, k) =>
      ["xyz"[k], (Math.abs(value) >= 1e7 || data.scale < 1e-5 || places === 12 ? numberText(value, 7)
        : String(Number(value.toFixed(places)))).replace("-", "\u2212") + " " + data.unit]);
    for (const column of data.columns) {
      const value = column.values[row];
      rows.push([column.title, column.kind === "category" && value === 0 ? "none"
        : this.lengthText(value, column.kind, 5)]);
    }
    this.card.replaceChildren(
      element("b", { textContent: `${data.noun} ${data.indices[row]}` + (image ? ", an image" : "") }),
      button("\u00d7", "Close (Esc)", close),
      element("table", {}, ...rows.map(([name, value]) =>
        element("tr", {}, element("th", { textContent: name }), element("td", { textContent: value })))));
    this.card.hidden = false;
  }
  closeCard() {
    this.card.hidden = true;
  }
}
