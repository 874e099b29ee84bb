// SPDX-License-Identifier: GPL-3.0-or-later
// Box plots of what cells have, over seeds and cases.

/// At part `q` of sorted values, between neighbours.
function quantile(sorted, q) {
  const place = q * (sorted.length - 1), i = Math.floor(place);
  return i + 1 < sorted.length ? sorted[i] + (place - i) * (sorted[i + 1] - sorted[i]) : sorted[i];
}

/// Quartiles, the ends of the whiskers (the last values within 1.5 interquartile ranges of the box), and what is beyond.
function boxOf(values) {
  const sorted = [...values].sort((a, b) => a - b), [q1, median, q3] = [0.25, 0.5, 0.75].map((q) => quantile(sorted, q));
  const reach = 1.5 * (q3 - q1), inside = sorted.filter((v) => v >= q1 - reach && v <= q3 + reach);
  return { n: sorted.length, q1, median, q3, low: inside[0], high: inside[inside.length - 1], beyond: sorted.filter((v) => v < q1 - reach || v > q3 + reach) };
}

/// A box of fewer values would say more than they do.
const kFewestForBox = 5;

/// Round numbers from low to high, about five.
function roundTicks(low, high) {
  const raw = (high - low) / 5, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find((m) => m * power >= raw) * power;
  const ticks = [];
  for (let i = Math.ceil(low / step); i * step <= high + 1e-9 * step; ++i) ticks.push(Number((i * step).toPrecision(6)));
  return ticks;
}

/// `rows`: a name, a colour and values each.
function boxChart(rows, title) {
  const row = 26, width = chartWidth(), left = 78, right = 62, top = 6, base = top + row * rows.length, all = rows.flatMap((r) => r.values);
  const least = all.reduce((a, b) => Math.min(a, b), Infinity), most = all.reduce((a, b) => Math.max(a, b), -Infinity);
  const room = 0.04 * (most - least || Math.abs(most) || 1), low = least - room, high = most + room;
  const x = (v) => left + ((width - left - right) * (v - low)) / (high - low);
  const told = rows.map((r) => `${r.name} median ${Number(boxOf(r.values).median.toPrecision(4))} of ${r.values.length}`);
  const chart = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${base + 38}`, role: "img", "aria-label": `Spread of ${title}: ${told.join(", ")}` });
  for (const tick of roundTicks(low, high)) chart.append(svg("path", { d: `M${x(tick)} ${top}V${base}`, class: "grid" }),
    text(x(tick), base + 15, tick, { "text-anchor": "middle", class: "soft" }));
  rows.forEach(({ name, colour, values }, i) => {
    const y = top + row * (i + 0.5), box = boxOf(values);
    const dots = values.length < kFewestForBox ? values : box.beyond;
    chart.append(text(left - 8, y + 4, name, { "text-anchor": "end", class: "word" }), text(width - right + 8, y + 4, `n = ${box.n}`, { class: "soft" }));
    if (values.length >= kFewestForBox) chart.append(
      svg("path", { d: `M${x(box.low)} ${y}H${x(box.q1)}M${x(box.q3)} ${y}H${x(box.high)}M${x(box.low)} ${y - 4}V${y + 4}M${x(box.high)} ${y - 4}V${y + 4}`, stroke: colour, fill: "none" }),
      svg("rect", { class: "box", x: x(box.q1), y: y - 8, width: Math.max(0.5, x(box.q3) - x(box.q1)), height: 16, fill: colour, "fill-opacity": 0.3, stroke: colour }),
      svg("path", { d: `M${x(box.median)} ${y - 8}V${y + 8}`, stroke: colour, "stroke-width": 2.4, fill: "none" }));
    for (const v of dots) chart.append(svg("circle", { cx: x(v), cy: y, r: 2.8, fill: colour, "fill-opacity": 0.7 }, svg("title", {}, `${name}: ${v}`)));
  });
  chart.append(svg("path", { d: `M${left} ${base}H${width - right}`, fill: "none", class: "axis" }), text((left + width - right) / 2, base + 33, title, { "text-anchor": "middle" }));
  return chart;
}

/// Fewer cells of every word have no spread.
const kFewestForSpread = 3;

class SpreadView {
  constructor(study) {
    this.study = study;
    this.node = el("div", { class: "spread" });
  }
  draw() {
    this.drawn = this.drawn || this.fill();
    return this.drawn;
  }
  async fill() {
    const data = JSON.parse(new TextDecoder().decode(await inflate(document.getElementById(this.study.samples).textContent)));
    const counts = data.words.map((_, w) => data.cells.filter((cell) => cell[1] === w).length);
    if (data.keys.length === 0 || Math.max(0, ...counts) < kFewestForSpread) return;
    this.data = data;
    const choice = (name, id, options) => {
      const node = el("select", { "data-choice": id, change: () => this.show() }, options.map(([value, title]) => el("option", { value }, title)));
      return [el("label", {}, name, node), node];
    };
    const [metricField, metric] = choice("Measure ", "metric", data.keys.map(({ title }, i) => [i, title]));
    const [sheetField, sheet] = choice("of ", "cells", [[-1, "all cases together"], ...data.sheets.map((name, i) => [i, name])]);
    const first = data.keys.findIndex(({ key }) => key === "eta_mean");
    metric.value = Math.max(0, first);
    Object.assign(this, { metric, sheet, place: el("div") });
    this.node.append(el("h3", {}, "Spread"), el("div", { class: "choices" }, metricField, sheetField), this.place, el("p", { class: "caption" },
      "Boxes from the first to the third quartile, with the median; whiskers to the last value within 1.5 times the box; dots for what is beyond, and for words with fewer than five values."));
    this.show();
    this.addTrade();
  }
  /// What fewer irregular vertices cost, where cases come in variants enough.
  addTrade() {
    const { cases, keys } = this.data, of = keys.findIndex(({ key }) => key === "n_irregular");
    const variants = cases.map((name) => cases.filter((other) => other === name).length);
    if (of < 0 || Math.max(...variants) < kFewestForSpread) return;
    const charts = ["tau", "eta_mean"].map((key) => keys.findIndex((k) => k.key === key)).filter((k) => k >= 0).map((k) => {
      const titles = [keys[k].title, keys[of].title];
      return chartFigure("", fileName(this.study.name, ...titles), tradeChart(this.linesOf(k, of), titles));
    });
    this.node.append(el("h3", {}, "Irregular vertices, and what fewer cost"), el("div", { class: "growth trade" }, charts), el("p", { class: "caption" },
      "A line for each case over its variants, in their order; a ring for a word on which they have no effect. Towards the lower right is better."));
  }
  /// A line for each case and word; points are means over seeds.
  linesOf(a, b) {
    const { cases, cells, sheets, words } = this.data, lines = new Map();
    const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
    sheets.forEach((sheet, s) => words.forEach((word, w) => {
      const known = cells.filter((cell) => cell[0] === s && cell[1] === w && cell[2 + a] !== null && cell[2 + b] !== null);
      if (known.length === 0) return;
      const key = `${cases[s]} ${word}`, line = lines.get(key) || { of: cases[s], word, points: [] };
      line.points.push([mean(known.map((cell) => cell[2 + a])), mean(known.map((cell) => cell[2 + b])), sheet]);
      lines.set(key, line);
    }));
    return [...lines.values()];
  }
  show() {
    const { words, keys, cells, sheets } = this.data, k = Number(this.metric.value), s = Number(this.sheet.value);
    const rows = words.map((name, w) => ({ name, colour: wordColour(words, name), values: cells.filter((cell) => cell[1] === w && (s < 0 || cell[0] === s))
      .map((cell) => cell[2 + k]).filter((v) => v !== null) })).filter((row) => row.values.length > 0);
    this.place.replaceChildren(rows.length === 0 ? el("p", { class: "hint" }, "No cell has a value here.")
      : chartFigure(s < 0 ? "All cases together" : sheets[s], fileName(this.study.name, "spread", keys[k].key, s < 0 ? "" : sheets[s]), boxChart(rows, keys[k].title)));
  }
}
