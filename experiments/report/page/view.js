// SPDX-License-Identifier: GPL-3.0-or-later
// The page of one mesh: shape and sizes by colour, names that are switched on and off, the worst quads.

/// What elements can be coloured by, from the lengths of their sides; eta comes with the mesh.
const kQuantities = {
  "shape (\u03b7)": kEta,
  "size": { name: "side", of: (sides) => sides.reduce((a, b) => a + b, 0) / sides.length },
  "aspect": { name: "longest to shortest side", of: (sides) => Math.max(...sides) / Math.min(...sides) },
  "names": null,
};
const kShapes = { label: "shape of the cell" };

const threeDigits = (value, round) => {
  const unit = 10 ** (Math.floor(Math.log10(value)) - 2);
  return value > 0 ? Number((round(value / unit) * unit).toPrecision(3)) : 0;
};

/// A value of each element, triangles first.
function measured(mesh, of) {
  const values = [], pieces = mesh.around / 4;
  eachElement(mesh, (nodes, n, at) => {
    const each = n === 3 ? 1 : pieces, sides = new Array(n / each).fill(0);
    for (let k = 0; k < n; ++k) {
      const a = nodes[at + k], b = nodes[at + ((k + 1) % n)];
      sides[Math.floor(k / each)] += Math.hypot(mesh.x[a] - mesh.x[b], mesh.y[a] - mesh.y[b], mesh.z[a] - mesh.z[b]);
    }
    values.push(of(sides));
  });
  return values;
}

/// Regions, or curves, of which each has its own row, but those of the same names one together; `count`: their elements.
/// `first`: of the colours, so that those of regions and curves differ; `pieces`: of each line of higher order.
function groupsOf(entities, entityOf, what, unnamed, first, pieces) {
  const groups = new Map(), groupOf = entities.map(({ tag, names }) => {
    const label = names.length > 0 ? names.join(", ") : unnamed ? `${unnamed} ${tag}` : null;
    if (label === null) return null;
    if (!groups.has(label)) groups.set(label, { label, what, count: 0, on: true, colour: kWordColours[(first + groups.size) % kWordColours.length] });
    return groups.get(label);
  });
  for (const e of entityOf) if (groupOf[e]) groupOf[e].count += 1 / pieces;
  return { groups: [...groups.values()].filter((g) => g.count > 0), of: Array.from(entityOf, (e) => groupOf[e]) };
}

/// How many irregular vertices each region has; those on its curves are other regions', too.
function countIrregular(mesh, groupOf) {
  const regionsAt = new Map(mesh.irregular.map(({ vertex }) => [vertex, new Set()])), count = mesh.triangles.length / 3;
  const add = (nodes, n, first) => nodes.forEach((v, i) => regionsAt.get(v)?.add(groupOf[first + Math.floor(i / n)]));
  add(mesh.triangles, 3, 0);
  add(mesh.quads, mesh.around, count);
  for (const groups of regionsAt.values()) for (const group of groups) if (group) group.irregular = (group.irregular || 0) + 1;
}

class MeshPage {
  constructor(data, mesh) {
    Object.assign(this, { data, mesh, colouredBy: Object.keys(kQuantities)[data.mesh.quads > 0 ? 0 : 1] });
    this.regions = groupsOf(data.regions, [...mesh.triangleRegion, ...mesh.quadRegion], "elements", data.mesh.dimension === 3 ? "face" : "region", 0, 1);
    countIrregular(mesh, this.regions.of);
    this.curves = groupsOf(data.curves, mesh.lineCurve, "lines", null, this.regions.groups.length, data.mesh.order);
    if (mesh.faceCells) Object.assign(kQuantities, { cells: kShapes });
    this.view = data.mesh.dimension === 3 ? new SpaceView() : new PlaneView();
    if (mesh.faceCells) this.origin = new THREE.Vector3(...data.mesh.origin);
    this.marks = [...data.closeups, ...data.points].map(({ at }) => at);
    this.fill();
  }
  fill() {
    const { data } = this, tool = (name, title, click) => el("button", { title, "aria-label": title, click }, name);
    const canvas = el("canvas", { tabindex: 0, role: "application", "aria-roledescription": "picture",
      "aria-label": `Mesh of ${data.values.n_elements || 0} elements. Arrows move or turn it, plus and minus zoom, R shows all of it.` });
    const save = el("div", { class: "head" });
    document.getElementById("picture").append(el("div", { class: "tools" }, data.mesh.dimension === 3 ? this.cutter() : [], tool("+", "Zoom in", () => this.view.zoomBy(1.6)),
      tool("\u2212", "Zoom out", () => this.view.zoomBy(1 / 1.6)), tool("Whole", "Show the whole mesh", () => this.view.reset())),
    el("figure", {}, canvas, save, this.hints().map((hint) => el("p", { class: "hint" }, hint))));
    this.colour();
    save.append(saveButtons(fileName(data.title), this.view.add(canvas, this.shown(), this.marks)));
    canvas.dataset.drawn = "yes";
    document.getElementById("about").append(...this.about());
  }
  /// Cuts a surface open across an axis, or takes whole cells away.
  cutter() {
    const cut = () => {
      part.hidden = axis.value === "";
      this.cut = part.hidden ? null : this.view.planeAt(Number(axis.value), Number(part.value));
      if (this.mesh.faceCells) return this.show();
      this.view.cutAt(this.cut);
    };
    const axis = el("select", { id: "cut-across", "aria-label": "Cut across", change: cut }, el("option", { value: "" }, "no cut"),
      ["x", "y", "z"].map((name, k) => el("option", { value: k }, `cut across ${name}`)));
    const part = el("input", { id: "cut-at", type: "range", min: 0, max: 1, step: "any", value: 0.5, hidden: "", "aria-label": "Where to cut", input: cut });
    return [axis, part];
  }
  hints() {
    const { step, failing } = this.data.mesh, shown = ["Drag to move or turn; Ctrl and the wheel zoom."];
    if (step > 1) shown.push(`Too large to be shown whole: one element of ${step} is drawn, larger than it is.`);
    if (failing > 0) shown.push(`${failing} quads beyond the criteria are red.`);
    return shown;
  }
  about() {
    const { data } = this, most = Math.max(0.05, Math.ceil((20 * Math.max(...data.eta)) / Math.max(1, data.eta.reduce((a, b) => a + b, 0))) / 20);
    const digits = { eta_mean: 3, eta_worst: 3, scaled_jacobian_min: 3, angle_min: 1, angle_max: 1, aspect_max: 2, d4: 1 };
    const parts = [keyNumbers(data.values, data.byKey, digits)];
    const points = data.points.map((point, i) => this.pointRow(point, data.closeups.length + i));
    const rows = [...this.regions.groups, ...this.curves.groups].map((group) => this.groupRow(group));
    if (rows.length + points.length > 0)
      parts.push(el("div", { class: "head" }, el("h3", {}, "Names"), el("span", { class: "save" },
        [["all", true], ["none", false]].map(([name, on]) => el("button", { click: () => this.turn(() => on) }, name)))),
      el("div", { class: "names" }, rows, points));
    if (data.closeups.length > 0)
      parts.push(el("h3", {}, "Worst quads"), el("div", { class: "closeups" }, closeupButtons(data, this.view)),
        chartFigure("Quads by \u03b7", fileName(data.title, "eta"), etaHistogram(data.eta, most, "Histogram of eta")));
    if (data.warnings.length > 0)
      parts.push(el("details", { class: "more" }, el("summary", {}, "Warnings"), el("ul", {}, data.warnings.map((w) => el("li", {}, w)))));
    return parts;
  }
  groupRow(group) {
    group.box = el("input", { type: "checkbox", checked: "", change: () => {
      group.on = group.box.checked;
      this.show();
    } });
    return el("div", {}, el("span", { class: "dot", style: `background:${group.colour}` }), el("label", {}, group.box, ` ${group.label} `,
      el("small", {}, `${grouped(Math.round(group.count))} ${group.what}${group.irregular ? `, ${grouped(group.irregular)} irregular` : ""}`)), el("button", { title: `Of all ${group.what} only these`,
      click: () => this.turn((other) => other === group || (other.what !== group.what && other.on)) }, "only"));
  }
  pointRow({ names, at }, place) {
    const box = el("input", { type: "checkbox", checked: "", change: () => {
      this.marks[place] = box.checked ? at : null;
      this.view.redraw();
    } });
    return el("div", {}, el("label", {}, box, ` ${names.join(", ")} `, el("small", {}, `point, number ${place + 1}`)));
  }
  turn(isOn) {
    for (const group of [...this.regions.groups, ...this.curves.groups]) group.box.checked = group.on = isOn(group);
    this.show();
  }
  /// Classes of colour of all elements, triangles first, by what they are coloured by now.
  colour() {
    const { mesh } = this, quantity = kQuantities[this.colouredBy];
    const choice = el("select", { id: "coloured-by", change: () => {
      this.colouredBy = choice.value;
      this.colour();
    } }, Object.keys(kQuantities).map((name) => el("option", { value: name }, kQuantities[name]?.label || name)));
    choice.value = this.colouredBy;
    Object.assign(palette, { fixed: quantity && quantity !== kShapes ? null : kWordColours, low: 0, high: 1 });
    let bar = el("div", { class: "bar" });
    this.classOfCell = mesh.faceCells && quantity === kEta ? (c) => mesh.cellClass[c] : quantity === kShapes ? (c) => mesh.cellShape[c] : null;
    if (quantity === kShapes) bar = el("div", { class: "bar" }, this.data.cells.map(({ name, number }, k) => number > 0 ? el("span", {},
      el("span", { class: "dot", style: `background:${kWordColours[k]}` }), ` ${name} `) : ""));
    if (this.classOfCell) this.classes = [];
    else if (quantity === null) this.classes = this.regions.of.map((group) => kWordColours.indexOf(group.colour));
    else if (quantity === kEta) this.classes = [...new Array(mesh.triangles.length / 3).fill(-1), ...mesh.eta];
    else {
      const values = measured(mesh, quantity.of), finite = values.filter(Number.isFinite);
      const from = threeDigits(finite.reduce((a, b) => Math.min(a, b), Infinity), Math.floor);
      const to = Math.max(threeDigits(finite.reduce((a, b) => Math.max(a, b), 0), Math.ceil), from * 1.01);
      this.classes = values.map((v) => Math.max(0, Math.min(kEtaClasses - 1, Math.floor((kEtaClasses * (v - from)) / (to - from)))));
      bar = colourBar({ name: quantity.name, from, to });
    }
    if (quantity === kEta) bar = colourBar();
    bar.prepend(el("label", {}, "Coloured by ", choice));
    document.getElementById("colours").replaceChildren(bar);
    this.show();
    palette.changed();
  }
  show() {
    if (this.view.pictures.length > 0) this.view.show(this.shown());
  }
  /// The cell that is seen on each face: of one that is kept and one that is cut away, the first; -1: none.
  seen() {
    const { mesh, cut } = this, isKept = (c) => c < mesh.cellShape.length &&
      (!cut || cut.normal.dot(new THREE.Vector3(...mesh.cellAt.subarray(3 * c, 3 * c + 3)).add(this.origin)) + cut.constant >= 0);
    const kept = Array.from(mesh.cellShape, (_, c) => isKept(c)).concat(false);
    return Array.from({ length: mesh.faceCells.length / 2 }, (_, f) => {
      const [a, b] = mesh.faceCells.subarray(2 * f, 2 * f + 2);
      return kept[a] === kept[b] ? -1 : kept[a] ? a : b;
    });
  }
  /// What is switched on: elements of such regions, and what lies on them.
  shown() {
    const { mesh } = this, count = mesh.triangles.length / 3, seen = mesh.faceCells && this.seen();
    const on = this.regions.of.map((group, i) => group.on && !(seen && seen[i] < 0));
    const classes = this.classOfCell ? seen.map((c) => (c < 0 ? -1 : this.classOfCell(c))) : this.classes;
    const used = new Uint8Array(mesh.x.length), bare = on.length === 0;
    const part = (nodes, n, first) => nodes.filter((v, i) => on[first + Math.floor(i / n)] && (used[v] = 1));
    const triangles = part(mesh.triangles, 3, 0), quads = part(mesh.quads, mesh.around, count);
    const isUsed = (v) => bare || used[v];
    const pairs = (ends) => ends.filter((_, i) => isUsed(ends[i - (i % 2)]) && isUsed(ends[i - (i % 2) + 1]));
    const strokes = this.curves.groups.filter((group) => group.on).map((group) => ({ colour: group.colour,
      ends: mesh.lines.filter((_, i) => this.curves.of[i >> 1] === group) }));
    return { ...mesh, triangles, quads, ofTriangles: classes.slice(0, count).filter((_, t) => on[t]),
      eta: classes.slice(count).filter((_, q) => on[count + q]), lines: pairs(mesh.lines), pairs: pairs(mesh.pairs),
      irregular: mesh.irregular.filter(({ vertex }) => isUsed(vertex)), strokes };
  }
}

async function main() {
  const data = JSON.parse(document.getElementById("data").textContent);
  Object.assign(kMarks, data.marks);
  kColourMaps.viridis = data.colours;
  if (data.mesh.cells > 0) Object.assign(kEta, { name: "scaled Jacobian", label: "scaled Jacobian" });
  data.byKey = Object.fromEntries(data.metrics.map((metric) => [metric.key, metric]));
  document.title = document.getElementById("top").textContent = data.title;
  try {
    const mesh = await unpackMesh(data.mesh), span = (axis) => Number(axis.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]).reduce((a, b) => b - a).toPrecision(4));
    document.getElementById("facts").textContent = `${[mesh.x, mesh.y, mesh.z].slice(0, data.mesh.dimension).map(span).join(" \u00d7 ")} ${data.unit}` + data.cells.map(({ name, number }) => (number > 0 ? `, ${grouped(number)} ${name}` : "")).join("") +
      (data.mesh.order > 1 ? `, elements of order ${data.mesh.order}` : "");
    new MeshPage(data, mesh);
  } catch (error) {
    document.getElementById("picture").append(el("div", { class: "missing failed" }, `The picture cannot be drawn here: ${error.message}`));
    console.error(error);
  }
  document.getElementById("origin").append(`Delquad ${data.program.delquad}, commit ${data.program.commit}, ${data.program.compiler}.`);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => palette.changed());
  document.documentElement.dataset.drawn = "all";
}
main();
