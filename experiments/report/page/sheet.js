// SPDX-License-Identifier: GPL-3.0-or-later
// The sheet of one case: its words side by side, a seed at a time.

/// Places are in hundredths of the quad's mean edge, eta in hundredths.
function closeupPicture(closeup) {
  const [box, all] = [320, closeup.points];
  const picture = svg("svg", { viewBox: `${-box} ${-box} ${2 * box} ${2 * box}`, "aria-hidden": "true" });
  closeup.elements.forEach((corners, i) => {
    picture.prepend(svg("polygon", { points: corners.map((v) => `${all[v][0]},${-all[v][1]}`).join(" "),
      ...(corners.length === 3 ? { fill: "#e4e7ea" } : byEta(closeup.etas[i] / 100)),
      stroke: i === 0 ? "#b3001b" : "#222", "stroke-width": i === 0 ? 12 : 3, "stroke-linejoin": "round" }));
  });
  return picture;
}

/// Which way a close-up looks and how large its quad is, for the big pictures to look there, too.
function closeupButtons(cell, view) {
  return cell.closeups.map((closeup, i) => el("button", {
    title: `${i + 1}: eta ${fixed(closeup.eta, 3)} at ${closeup.at.map((v) => Number(v.toPrecision(5))).join(", ")}`,
    click: () => view.lookAt(closeup.at, closeup.size, closeup.normal),
  }, closeupPicture(closeup), `${i + 1}: \u03b7 = ${fixed(closeup.eta, 3)}`));
}

function keyNumbers(values, metrics, digits = { eta_mean: 3, eta_worst: 3, d4: 1, tau: 1 }) {
  const item = (name, value, title) => el("div", { title }, el("dt", {}, name), el("dd", {}, value));
  const items = [];
  for (const key of ["n_vertices", "n_quads", "n_triangles"])
    if (values[key] > 0) items.push(item(metrics[key].title, grouped(values[key]), metrics[key].source));
  for (const [key, places] of Object.entries(digits))
    if (typeof values[key] === "number") items.push(item(metrics[key].title, fixed(values[key], places), metrics[key].source));
  if (values.seconds !== undefined) items.push(item("time", seconds(values.seconds), "from insertion to the finished mesh, by a clock on the wall"));
  return el("dl", { class: "numbers" }, items);
}

/// What tables of means show of the columns that there are, besides measures of one's own.
const kMeansOf = ["n_quads", "eta_worst", "eta_mean", "d4", "tau", "seconds"];

/// Means over the seeds, a row for each word.
function meansNode(means, columns) {
  const shown = columns.filter(({ key }) => kMeansOf.includes(key) && means.some((m) => key in m.values));
  const cell = (line, { key, digits, range }) => {
    if (!(key in line.values)) return el("td", {}, "\u2013");
    const [value, around] = shownNumber(line.values[key], line.half_widths[key], digits, range);
    return el("td", {}, value, around ? el("span", { class: "beside" }, around) : null);
  };
  return el("div", { class: "scroll means", tabindex: 0, role: "region", "aria-label": "Means over the seeds" }, el("table", {}, el("thead", {}, el("tr", {}, ["mean of", "seeds", ...shown.map((c) => c.title)].map((t) => el("th", { scope: "col" }, t)))),
    el("tbody", {}, means.map((line) => el("tr", {}, el("th", { scope: "row", class: "word" }, line.word), el("td", {}, line.n), shown.map((c) => cell(line, c)))))));
}

class Sheet {
  constructor(sheet, words, glossary, columns) {
    Object.assign(this, { sheet, words, glossary, columns, drawn: null, place: 0 });
    this.node = this.build();
  }
  get cells() {
    return this.sheet.seeds[this.place].cells;
  }
  build() {
    const { sheet } = this, tool = (name, title, click) => el("button", { title, "aria-label": title, click }, name);
    const hasPictures = sheet.seeds.some(({ cells }) => cells.some((cell) => cell.mesh));
    const tools = hasPictures ? el("div", { class: "tools" },
      tool("+", "Zoom in", () => this.view.zoomBy(1.6)), tool("\u2212", "Zoom out", () => this.view.zoomBy(1 / 1.6)),
      tool("Whole", "Show the whole mesh", () => this.view.reset())) : null;
    this.content = el("div");
    const section = el("section", { class: "sheet", id: sheet.id },
      el("header", {}, el("h3", {}, sheet.name), sheet.variant.map((v) => el("span", { class: "chip" }, v)), this.seedChooser(), tools),
      el("div", { class: "facts" }, sheet.facts.map(([key, value]) => el("span", {}, key + ": ", el("b", {}, value)))),
      sheet.means.length > 0 ? meansNode(sheet.means, this.columns) : null, this.content);
    this.fill();
    return section;
  }
  /// Of a sheet with several seeds: one is shown at a time.
  seedChooser() {
    const { seeds } = this.sheet;
    if (seeds.length < 2) return seeds[0].seed === "" ? null : el("span", { class: "chip" }, `seed ${seeds[0].seed}`);
    const choice = el("select", { "data-choice": "seed", change: () => this.show(Number(choice.value)) }, seeds.map(({ seed }, i) => el("option", { value: i }, seed)));
    const step = (by, name, title) => el("button", { title, "aria-label": title, click: () => {
      choice.value = (this.place + by + seeds.length) % seeds.length;
      this.show(Number(choice.value));
    } }, name);
    return el("span", { class: "seeds" }, el("label", {}, "seed ", choice), ` of ${seeds.length} `, step(-1, "\u2039", "The seed before"), step(1, "\u203a", "The next seed"));
  }
  show(place) {
    const wasDrawn = this.drawn !== null;
    this.place = place;
    this.drawn = null;
    this.fill();
    return wasDrawn ? this.draw() : null;
  }
  /// What belongs to the seed that is shown.
  fill() {
    if (this.view) this.view.end();
    const { cells } = this, dimension = Math.max(2, ...cells.map((cell) => (cell.mesh ? cell.mesh.dimension : 2)));
    this.view = dimension === 3 ? new SpaceView() : new PlaneView();
    this.pictures = [];
    const done = cells.filter((cell) => cell.status === "ok");
    const most = Math.max(0.01, ...done.map((cell) => Math.max(...cell.eta) / Math.max(1, cell.eta.reduce((a, b) => a + b, 0))));
    this.content.replaceChildren(el("div", { class: "cards" }, cells.map((cell) => this.card(cell, Math.ceil(most * 20) / 20))), this.below(done));
  }
  below(done) {
    const below = el("div", { class: "below" });
    if (done.length > 0)
      below.append(el("div", {}, chartFigure("Time by step", this.fileName("time"), timeBars(done, this.glossary.steps), el("p", { class: "caption" },
        "Times of all threads added up. Words that begin alike share their first steps; each shows them."))));
    const smoothed = done.filter((cell) => cell.energy);
    if (smoothed.length > 0)
      below.append(el("div", {}, chartFigure("Convergence of smoothing (L)", this.fileName("convergence"), convergenceChart(smoothed, this.words),
        el("p", { class: "caption" }, "Energy of the points' cells, which smoothing makes smaller; a line for each patch",
          smoothed.some((c) => c.patches > c.energy.length) ? ", of the first twelve" : "",
          ". It jumps where size and directions are taken anew."))));
    return below;
  }
  fileName(...parts) {
    const { seed } = this.sheet.seeds[this.place];
    return fileName(this.sheet.id, seed === "" ? "" : `seed=${seed}`, ...parts);
  }
  wordSteps({ word, peer }) {
    if (peer) return `another mesher, version ${peer.version || "unknown"}`;
    const names = Object.fromEntries(this.glossary.letters.map((l) => [l.letter, l.name]));
    return [...word].map((letter) => names[letter] || letter).join(", ");
  }
  card(cell, most) {
    const card = el("article", { class: "card", style: `--colour:${wordColour(this.words, cell.word)}` },
      el("div", { class: "name" }, el("span", { class: "word" }, cell.word), el("small", {}, this.wordSteps(cell))));
    if (cell.status !== "ok") {
      card.append(el("div", { class: `missing ${cell.status}` }, `${cell.status}: ${cell.reason}`));
      return card;
    }
    card.append(el("div", {}, this.picture(cell)), keyNumbers(cell.values, this.glossary.byKey));
    card.append(el("div", {}, cell.values.n_quads > 0 ? chartFigure("Quads by \u03b7", this.fileName(cell.word, "eta"),
      etaHistogram(cell.eta, most, `Histogram of eta, ${cell.word}`)) : []));
    card.append(el("div", {}, chartFigure(`Vertices inside by number of ${cell.valences.of} around`, this.fileName(cell.word, "valences"), valenceBars(cell.valences),
      cell.valences.mixed > 0 ? el("p", { class: "caption" }, "\u25b3: with a triangle among them") : [])));
    card.append(el("div", {}, cell.closeups ? [el("h4", {}, "Worst quads"),
      el("div", { class: "closeups" }, closeupButtons(cell, this.view))] : [], this.more(cell)));
    return card;
  }
  more(cell) {
    const lines = [...(cell.peer ? [`command: ${cell.peer.command.join(" ")}`] : []), ...(cell.surface || []).map(([k, v]) => `${k}: ${v}`), ...cell.warnings.map((w) => `warning: ${w}`)];
    if (lines.length === 0) return null;
    return el("details", { class: "more" }, el("summary", {}, cell.peer ? "Command and warnings" : cell.surface ? "Surface and warnings" : "Warnings"),
      el("ul", {}, lines.map((line) => el("li", {}, line))));
  }
  picture(cell) {
    if (!cell.mesh) return el("div", { class: "missing" }, `No picture: ${cell.no_picture}`);
    const does = cell.mesh.dimension === 3 ? "turn" : "move";
    const canvas = el("canvas", { tabindex: 0, role: "application", "aria-roledescription": "picture", "aria-label":
      `Mesh of ${this.sheet.name} by ${cell.word}: ${cell.values.n_elements} elements. Arrows ${does} it, plus and minus zoom, R shows all of it.` });
    canvas.style.aspectRatio = 1.25;
    const buttons = el("div", { class: "head" });
    this.pictures.push({ canvas, cell, buttons });
    const failing = cell.mesh.failing > 0 ? el("p", { class: "hint" }, `${cell.mesh.failing} quads beyond the criteria are red.`) : null;
    return el("figure", {}, canvas, buttons, failing);
  }
  /// Once for each seed.
  draw() {
    this.drawn = this.drawn || this.drawAll(this.view);
    return this.drawn;
  }
  async drawAll(view) {
    for (const { canvas, cell, buttons } of this.pictures) {
      if (view !== this.view) return;  // another seed is shown by now
      try {
        const mesh = await unpackMesh(cell.mesh);
        if (view !== this.view) return;
        const source = view.add(canvas, mesh, (cell.closeups || []).map((c) => c.at));
        buttons.replaceChildren(saveButtons(this.fileName(cell.word, "mesh"), source));
        canvas.dataset.drawn = "yes";
      } catch (error) {
        canvas.replaceWith(el("div", { class: "missing failed" }, `The picture cannot be drawn here: ${error.message}`));
        console.error(error);
      }
    }
  }
}
