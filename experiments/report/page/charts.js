// SPDX-License-Identifier: GPL-3.0-or-later
// Charts, drawn from numbers.

function text(x, y, content, attributes = {}) {
  return svg("text", { x, y, "font-size": 11, ...attributes }, content);
}

/// Of large charts: so wide that their letters can be read on a telephone, too.
const chartWidth = () => Math.min(560, Math.max(300, document.documentElement.clientWidth - 56));

/// Bars of eta from 0 to 1, as parts of all quads; `most`: the top of the axis.
function etaHistogram(counts, most, label) {
  const width = 320, height = 96, left = 34, base = 78, top = 8;
  const total = counts.reduce((a, b) => a + b, 0) || 1;
  const step = (width - left - 8) / counts.length;
  const chart = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  const y = (part) => base - (base - top) * Math.min(1, part / most);
  chart.append(svg("path", { d: `M${left} ${base}H${width - 8}`, class: "axis" }));
  counts.forEach((count, i) => {
    chart.append(svg("rect", { x: left + i * step + 0.5, y: y(count / total), width: step - 1, height: base - y(count / total),
      ...byEta((i + 0.5) / counts.length) }, svg("title", {}, `${(i / counts.length).toFixed(2)} to ${((i + 1) / counts.length).toFixed(2)}: ${grouped(count)} quads`)));
  });
  for (const tick of [0, 0.5, 1]) chart.append(text(left + tick * (width - left - 8), 92, tick, { "text-anchor": "middle", class: "soft" }));
  chart.append(text(left - 4, top + 8, `${Math.round(100 * most)}%`, { "text-anchor": "end", class: "soft" }));
  chart.append(text(left - 4, base, "0", { "text-anchor": "end", class: "soft" }));
  return chart;
}

/// Shares of all vertices inside by how many elements are around them; those with a triangle among quads have one bar.
function valenceBars({ of, counts, mixed }) {
  const regular = of === "triangles" ? 6 : 4;
  const entries = Object.entries(counts).map(([k, n]) => [Number(k), n]).sort((a, b) => a[0] - b[0]);
  if (mixed > 0) entries.push(["\u25b3", mixed]);
  const total = entries.reduce((sum, e) => sum + e[1], 0) || 1;
  const row = 15, width = 320, left = 34, right = 66;
  const share = (n) => `${fixed((100 * n) / total, n / total < 0.01 ? 2 : 1)} %`;
  const label = entries.map(([k, n]) => `${k === "\u25b3" ? "with triangles" : k}: ${share(n)}`).join(", ");
  const chart = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${row * entries.length + 2}`, role: "img", "aria-label": `Around vertices: ${label}` });
  entries.forEach(([valence, count], i) => {
    const y = i * row, long = ((width - left - right) * count) / total;
    const colour = valence === regular ? "#9fb4bd" : valence === "\u25b3" ? "#c9ced4" : markColour(valence, regular);
    chart.append(text(left - 8, y + 11, valence, { "text-anchor": "end" }),
      svg("rect", { x: left, y: y + 2, width: Math.max(long, 0.8), height: row - 5, fill: colour }),
      text(left + long + 5, y + 11, share(count), { class: "soft" }));
  });
  return chart;
}

/// Squares of colour with names below a chart, which grows by their rows.
function addLegend(chart, entries) {
  const [, , width, height] = chart.getAttribute("viewBox").split(" ").map(Number);
  let x = 8, y = height + 4;
  for (const [name, colour] of entries) {
    const long = 26 + 6.8 * name.length;
    if (x > 8 && x + long > width) [x, y] = [8, y + 17];
    chart.append(svg("rect", { x, y, width: 10, height: 10, rx: 2, fill: colour }), text(x + 15, y + 9, name));
    x += long;
  }
  chart.setAttribute("viewBox", `0 0 ${width} ${y + 16}`);
  return chart;
}

const kStepColours = ["#c9b79c", "#a3c4bc", "#e2a06a", "#7fa9d6", "#d5586b", "#8c6bb1", "#41ab7d", "#f0cb5b", "#5b7c8d", "#b5c267", "#9b8b7a"];

/// A bar for each word, made of its steps.
function timeBars(cells, steps) {
  const used = steps.filter((step) => cells.some((cell) => cell.steps[step] > 0));
  const sums = cells.map((cell) => used.reduce((sum, step) => sum + (cell.steps[step] || 0), 0));
  const most = Math.max(...sums), row = 24, width = chartWidth(), left = 62, right = 62;
  const chart = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${row * cells.length + 4}`, role: "img",
    "aria-label": "Seconds by step: " + cells.map((c, i) => `${c.word} ${seconds(sums[i])}`).join(", ") });
  cells.forEach((cell, i) => {
    let x = left;
    chart.append(text(left - 8, i * row + 17, cell.word, { "text-anchor": "end", class: "word" }));
    for (const step of used) {
      const long = ((width - left - right) * (cell.steps[step] || 0)) / most;
      chart.append(svg("rect", { x, y: i * row + 4, width: long, height: row - 7, fill: kStepColours[steps.indexOf(step) % kStepColours.length] },
        svg("title", {}, `${cell.word}, ${step}: ${seconds(cell.steps[step] || 0)}`)));
      x += long;
    }
    chart.append(text(x + 6, i * row + 17, seconds(sums[i]), { class: "soft" }));
  });
  return addLegend(chart, used.map((step) => [step, kStepColours[steps.indexOf(step) % kStepColours.length]]));
}

const powersBetween = (low, high) => {
  const powers = [];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) powers.push(e);
  return powers;
};

/// Axes around points [x, y], in powers of ten where `powers` says so; returns the chart and the maps to it.
function axesAround(points, titles, label, powers = [true, true]) {
  const width = chartWidth(), height = 330, left = 64, right = 30, top = 12, bottom = 44;
  const scaled = (v, k) => (powers[k] ? Math.log10(v) : v);
  const range = (k) => {
    const values = points.map((p) => scaled(p[k], k)), low = Math.min(...values), high = Math.max(...values);
    const room = 0.08 * (powers[k] ? Math.max(high - low, 0.5) : high - low || 1);
    return [low - room, high + room];
  };
  const [x0, x1] = range(0), [y0, y1] = range(1);
  const x = (v) => left + ((width - left - right) * (scaled(v, 0) - x0)) / (x1 - x0);
  const y = (v) => height - bottom - ((height - top - bottom) * (scaled(v, 1) - y0)) / (y1 - y0);
  const chart = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  const ticks = (k, low, high, add) => {
    if (!powers[k]) return roundTicks(low, high).forEach(add);
    const factors = high - low < 0.6 ? [1, 1.5, 2, 3, 4, 5, 6, 8] : high - low < 2.5 ? [1, 2, 5] : [1];
    for (const e of powersBetween(10 ** low, 10 ** high))
      for (const m of factors) {
        const v = m * 10 ** e;
        if (Math.log10(v) >= low && Math.log10(v) <= high) add(v);
      }
  };
  const short = (v) => (v >= 1000 ? grouped(v) : String(Number(v.toPrecision(3))));
  ticks(0, x0, x1, (v) => chart.append(svg("path", { d: `M${x(v)} ${top}V${height - bottom}`, class: "grid" }),
    text(x(v), height - bottom + 15, short(v), { "text-anchor": "middle", class: "soft" })));
  ticks(1, y0, y1, (v) => chart.append(svg("path", { d: `M${left} ${y(v)}H${width - right}`, class: "grid" }),
    text(left - 6, y(v) + 4, short(v), { "text-anchor": "end", class: "soft" })));
  chart.append(svg("path", { d: `M${left} ${top}V${height - bottom}H${width - right}`, fill: "none", class: "axis" }),
    text((left + width - right) / 2, height - 6, titles[0], { "text-anchor": "middle" }),
    text(14, (top + height - bottom) / 2, titles[1], { "text-anchor": "middle", transform: `rotate(-90 14 ${(top + height - bottom) / 2})` }));
  return { chart, x, y };
}

/// Seconds by number of elements, both in powers, with the laws that were fitted.
function growthChart(growth, words) {
  const all = growth.flatMap((g) => g.points);
  const { chart, x, y } = axesAround(all, ["elements", "seconds"], "Seconds by number of elements, both axes logarithmic");
  for (const { word, points, law } of growth) {
    const colour = wordColour(words, word), sizes = points.map((p) => p[0]);
    if (law) {
      const ends = [Math.min(...sizes), Math.max(...sizes)].map((n) => `${x(n)} ${y(law.factor * n ** law.exponent)}`);
      chart.append(svg("path", { d: `M${ends.join("L")}`, stroke: colour, "stroke-width": 1.3, "stroke-dasharray": "5 3", fill: "none" }));
    }
    for (const [n, s, group] of points)
      chart.append(svg("circle", { cx: x(n), cy: y(s), r: 3.6, fill: colour, "fill-opacity": 0.75 },
        svg("title", {}, `${word}, ${group}: ${grouped(n)} elements, ${seconds(s)}`)));
  }
  return addLegend(chart, [...new Set(growth.map((g) => g.word))].map((word) => [word, wordColour(words, word)]));
}

/// One measure against another over what varies: a line for each case, `lines` of { of, word, points: [x, y, name] }.
function tradeChart(lines, titles) {
  const all = lines.flatMap((line) => line.points), cases = [...new Set(lines.map((line) => line.of))];
  const { chart, x, y } = axesAround(all, titles, `${titles[1]} against ${titles[0]}`, [false, all.every((p) => p[1] > 0)]);
  for (const { of, word, points } of lines) {
    const colour = wordColour(cases, of), varies = points.some((p) => p[0] !== points[0][0] || p[1] !== points[0][1]);
    chart.append(svg("path", { d: `M${points.map((p) => `${x(p[0])} ${y(p[1])}`).join("L")}`, stroke: colour, "stroke-width": 1.5, fill: "none" }));
    for (const [px, py, name] of varies ? points : points.slice(0, 1))
      chart.append(svg("circle", { cx: x(px), cy: y(py), r: 3.6, fill: varies ? colour : "none", stroke: colour },
        svg("title", {}, `${name}, ${word}: ${titles[1]} ${grouped(py)}, ${titles[0]} ${Number(px.toPrecision(4))}`)));
  }
  return addLegend(chart, cases.map((of) => [of, wordColour(cases, of)]));
}

/// By which power of the number of elements time grows, as far as it is known.
function growthLaws(growth) {
  const laws = growth.filter((g) => g.law).map((g) => el("tr", {}, el("td", {}, g.case), el("td", { class: "word" }, g.word),
    el("td", {}, `N^${fixed(g.law.exponent, 2)}`)));
  return laws.length === 0 ? null : el("table", {}, el("thead", {}, el("tr", {}, ["case", "pipeline", "time grows as"].map((t) => el("th", { scope: "col" }, t)))),
    el("tbody", {}, laws));
}

/// Energy by evaluation: a line for each patch of each word.
function convergenceChart(cells, words) {
  const width = chartWidth(), height = 250, left = 64, right = 16, top = 12, bottom = 40;
  const lines = cells.flatMap((cell) => cell.energy.map((energies) => ({ word: cell.word, energies })));
  const known = lines.flatMap((line) => line.energies.filter((e) => e !== null));
  const longest = Math.max(2, ...lines.map((line) => line.energies.length));
  const low = Math.min(...known), high = Math.max(...known), room = 0.05 * (high - low || 1);
  const x = (i) => left + ((width - left - right) * i) / (longest - 1);
  const y = (e) => height - bottom - ((height - top - bottom) * (e - low + room)) / (high - low + 2 * room);
  const chart = svg("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "Energy by evaluation" });
  for (const part of [0, 0.25, 0.5, 0.75, 1]) {
    const e = low + part * (high - low);
    chart.append(svg("path", { d: `M${left} ${y(e)}H${width - right}`, class: "grid" }),
      text(left - 6, y(e) + 4, Number(e.toPrecision(3)), { "text-anchor": "end", class: "soft" }));
  }
  for (const { word, energies } of lines) {
    let path = "";
    energies.forEach((e, i) => {
      if (e !== null) path += `${path === "" || energies[i - 1] === null ? "M" : "L"}${x(i).toFixed(1)} ${y(e).toFixed(1)}`;
    });
    chart.append(svg("path", { d: path, fill: "none", stroke: wordColour(words, word), "stroke-width": 1.3, "stroke-opacity": 0.8 }));
  }
  for (const i of [0, Math.round((longest - 1) / 2), longest - 1])
    chart.append(text(x(i), height - bottom + 15, i + 1, { "text-anchor": "middle", class: "soft" }));
  chart.append(svg("path", { d: `M${left} ${top}V${height - bottom}H${width - right}`, fill: "none", class: "axis" }),
    text((left + width - right) / 2, height - 6, "evaluation", { "text-anchor": "middle" }),
    text(14, (top + height - bottom) / 2, "energy of a cell", { "text-anchor": "middle", transform: `rotate(-90 14 ${(top + height - bottom) / 2})` }));
  return addLegend(chart, cells.map((cell) => [cell.word, wordColour(words, cell.word)]));
}
