// SPDX-License-Identifier: GPL-3.0-or-later
// Colours: of the page, light or dark, of words, and of eta.

const kWordColours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#b58900", "#7b4fa3", "#6b7280"];
const wordColour = (words, word) => kWordColours[words.indexOf(word) % kWordColours.length];

const kMarks = {};  // colours of irregular vertices, from the data
const markColour = (valence, regular) =>
  valence === regular - 1 ? kMarks["one less"] : valence === regular + 1 ? kMarks["one more"] : kMarks.other;

/// A colour of the style sheet as it is for a node: light or dark.
function themed(node, name) {
  const probe = el("span", { style: `color:var(${name})` });
  (node || document.body).append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

const channels = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

/// From dark to light, and told apart by the colour-blind; viridis comes with the data.
const kColourMaps = {
  cividis: ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"],
  magma: ["#0b0722", "#231151", "#5f187f", "#982d80", "#d3436e", "#f8765c", "#febb81", "#fcfdbf"],
  grey: ["#262626", "#f2f2f2"],
};

/// Which colour a value of eta has, by the map and the range that were chosen.
class Palette {
  constructor() {
    Object.assign(this, { map: "viridis", low: 0, high: 1, fixed: null, followers: new Set() });
  }
  /// `at`: a value of eta; what is outside of the range has the colour of its end.
  colour(at) {
    const stops = kColourMaps[this.map], part = Math.min(1, Math.max(0, (at - this.low) / (this.high - this.low)));
    const place = part * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(place));
    const [a, b] = [channels(stops[i]), channels(stops[i + 1])];
    return `#${a.map((v, k) => Math.round(v + (b[k] - v) * (place - i)).toString(16).padStart(2, "0")).join("")}`;
  }
  /// Of every class of eta in a mesh, and of quads that fail; or those that are `fixed`.
  classes() {
    return this.fixed || [...Array.from({ length: kEtaClasses }, (_, i) => this.colour((i + 0.5) / kEtaClasses)), "#e4003a"];
  }
  choose(map, low, high) {
    Object.assign(this, { map, low, high });
    this.changed();
  }
  /// Paints anew what has a colour by eta: marked nodes, and the pictures that follow.
  changed() {
    for (const node of document.querySelectorAll("[data-eta]")) node.setAttribute("fill", this.colour(Number(node.dataset.eta)));
    for (const follower of this.followers) follower.repaint();
  }
}
const palette = new Palette();

/// Attributes of a node that keeps the colour of this eta.
const byEta = (eta) => ({ "data-eta": Number(eta.toFixed(4)), fill: palette.colour(eta) });

const kEta = { name: "\u03b7", from: 0, to: 1 };

/// The colours that a quantity has now, as a figure.
function scaleChart({ name, from, to }) {
  const width = 260, height = 34, steps = 64, left = 8, wide = width - 2 * left;
  const value = (part) => Number((from + (palette.low + part * (palette.high - palette.low)) * (to - from)).toPrecision(3));
  const chart = svg("svg", { class: "chart scale", viewBox: `0 0 ${width} ${height}`, role: "img",
    "aria-label": `Colours from ${name} ${value(0)}, dark, to ${name} ${value(1)}, light` });
  for (let i = 0; i < steps; ++i) {
    const eta = palette.low + ((i + 0.5) / steps) * (palette.high - palette.low);
    chart.append(svg("rect", { x: left + (i * wide) / steps, y: 2, width: wide / steps + 0.3, height: 14, fill: palette.colour(eta) }));
  }
  const label = (part, anchor, more) => svg("text", { x: left + part * wide, y: 29, "font-size": 11, "text-anchor": anchor, class: "soft" },
    more + value(part));
  chart.append(label(0, "start", `${name} = `), label(0.5, "middle", ""), label(1, "end", ""));
  return chart;
}

/// The choice of colours and of light or dark, and the scale of a quantity from its least to its largest value.
function colourBar(quantity = kEta) {
  const { name, from: least, to: most } = quantity;
  const holder = el("div", { class: "scale-holder" }, scaleChart(quantity));
  const maps = el("select", { id: "colour-map", change: () => apply() }, ["viridis", ...Object.keys(kColourMaps).filter((m) => m !== "viridis")].map((m) => el("option", {}, m)));
  const end = (id, value) => el("input", { id, type: "number", min: least, max: most, step: (most - least) / 20, value, change: () => apply() });
  const low = end("colour-low", least), high = end("colour-high", most);
  const complaint = el("span", { class: "failed", role: "status" });
  const apply = () => {
    const [from, to] = [Number(low.value), Number(high.value)];
    const wrong = !(from >= least && to <= most && from < to);
    complaint.textContent = wrong ? `The range must be two numbers from ${least} to ${most}, the first less than the second.` : "";
    if (wrong) return;
    palette.choose(maps.value, (from - least) / (most - least), (to - least) / (most - least));
    holder.replaceChildren(scaleChart(quantity));
  };
  const theme = el("select", { id: "theme", change: () => {
    if (theme.value === "as the system") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme.value;
    palette.changed();
  } }, ["as the system", "light", "dark"].map((t) => el("option", {}, t)));
  const field = (name, ...nodes) => el("label", {}, name, nodes);
  return el("div", { class: "bar", role: "group", "aria-label": "Colours" }, field("Colours ", maps), field(`${name} from `, low), field("to ", high),
    holder, saveButtons(quantity === kEta ? "eta-scale" : "scale", chartSource(() => holder.firstChild)), complaint, field("Page ", theme));
}
