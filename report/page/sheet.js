// The sheet of one case: its words side by side.

/// Places are in hundredths of the quad's mean edge, eta in hundredths.
function closeupPicture(closeup, colours) {
  const [box, all] = [320, closeup.points];
  const picture = svg("svg", { viewBox: `${-box} ${-box} ${2 * box} ${2 * box}`, "aria-hidden": "true" });
  closeup.elements.forEach((corners, i) => {
    const colour = corners.length === 3 ? "#e4e7ea" : colours[Math.min(colours.length - 1, Math.floor((closeup.etas[i] / 100) * colours.length))];
    picture.prepend(svg("polygon", { points: corners.map((v) => `${all[v][0]},${-all[v][1]}`).join(" "), fill: colour,
      stroke: i === 0 ? "#b3001b" : "#222", "stroke-width": i === 0 ? 12 : 3, "stroke-linejoin": "round" }));
  });
  return picture;
}

/// Which way a close-up looks and how large its quad is, for the big pictures to look there, too.
function closeupButtons(cell, view, colours) {
  return cell.closeups.map((closeup, i) => el("button", {
    title: `${i + 1}: eta ${fixed(closeup.eta, 3)} at ${closeup.at.map((v) => Number(v.toPrecision(5))).join(", ")}`,
    click: () => view.lookAt(closeup.at, closeup.size, closeup.normal),
  }, closeupPicture(closeup, colours), `${i + 1}: \u03b7 = ${fixed(closeup.eta, 3)}`));
}

function keyNumbers(values, metrics) {
  const digits = { eta_mean: 3, eta_worst: 3, d4: 1, tau: 1 };
  const item = (name, value, title) => el("div", { title }, el("dt", {}, name), el("dd", {}, value));
  const items = [];
  for (const key of ["n_vertices", "n_quads", "n_triangles"])
    if (values[key] > 0) items.push(item(metrics[key].title, grouped(values[key]), metrics[key].source));
  for (const [key, places] of Object.entries(digits))
    if (typeof values[key] === "number") items.push(item(metrics[key].title, fixed(values[key], places), metrics[key].source));
  if (values.seconds !== undefined) items.push(item("time", seconds(values.seconds), "from insertion to the finished mesh, by a clock on the wall"));
  return el("dl", { class: "numbers" }, items);
}

class Sheet {
  constructor(sheet, words, glossary) {
    Object.assign(this, { sheet, words, glossary, drawn: null });
    const dimension = Math.max(2, ...sheet.cells.map((cell) => (cell.mesh ? cell.mesh.dimension : 2)));
    this.view = dimension === 3 ? new SpaceView(glossary.colours) : new PlaneView(glossary.colours);
    this.canvases = [];
    this.node = this.build();
  }
  build() {
    const { sheet } = this, done = sheet.cells.filter((cell) => cell.status === "ok");
    const tool = (name, title, click) => el("button", { title, "aria-label": title, click }, name);
    const tools = this.sheet.cells.some((cell) => cell.mesh) ? el("div", { class: "tools" },
      tool("+", "Zoom in", () => this.view.zoomBy(1.6)), tool("\u2212", "Zoom out", () => this.view.zoomBy(1 / 1.6)),
      tool("Whole", "Show the whole mesh", () => this.view.reset())) : null;
    const most = Math.max(0.01, ...done.map((cell) => Math.max(...cell.eta) / Math.max(1, cell.eta.reduce((a, b) => a + b, 0))));
    const section = el("section", { class: "sheet", id: sheet.id },
      el("header", {}, el("h3", {}, sheet.name), sheet.variant.map((v) => el("span", { class: "chip" }, v)), tools),
      el("div", { class: "facts" }, sheet.facts.map(([key, value]) => el("span", {}, key + ": ", el("b", {}, value)))),
      el("div", { class: "cards" }, sheet.cells.map((cell) => this.card(cell, Math.ceil(most * 20) / 20))));
    const below = el("div", { class: "below" });
    if (done.length > 0)
      below.append(el("div", {}, el("h4", {}, "Time by step"), timeBars(done, this.glossary.steps), el("p", { class: "caption" },
        "Times of all threads added up. Words that begin alike share their first steps; each shows them.")));
    const smoothed = done.filter((cell) => cell.energy);
    if (smoothed.length > 0)
      below.append(el("div", {}, el("h4", {}, "Convergence of smoothing (L)"), convergenceChart(smoothed, this.words),
        el("p", { class: "caption" }, "Energy of the points' cells, which smoothing makes smaller; a line for each patch",
          smoothed.some((c) => c.patches > c.energy.length) ? ", of the first twelve" : "",
          ". It jumps where size and directions are taken anew.")));
    section.append(below);
    return section;
  }
  wordSteps({ word, peer }) {
    if (peer) return `another mesher, version ${peer.version}`;
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
    const hasQuads = cell.values.n_quads > 0;
    card.append(el("div", {}, hasQuads ? [el("h4", {}, "Quads by \u03b7"), etaHistogram(cell.eta, most, this.glossary.colours, `Histogram of eta, ${cell.word}`)] : []));
    card.append(el("div", {}, el("h4", {}, `Vertices inside by number of ${hasQuads ? "quads" : "triangles"} around`),
      valenceBars(cell.valences, hasQuads ? 4 : 6)));
    card.append(el("div", {}, cell.closeups ? [el("h4", {}, "Worst quads"),
      el("div", { class: "closeups" }, closeupButtons(cell, this.view, this.glossary.colours))] : [], this.more(cell)));
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
    const canvas = el("canvas", { tabindex: 0, role: "img",
      "aria-label": `Mesh of ${this.sheet.name} by ${cell.word}: ${cell.values.n_elements} elements` });
    canvas.style.aspectRatio = 1.25;
    this.canvases.push([canvas, cell]);
    const thin = cell.mesh.step > 1 ? el("p", { class: "hint" },
      `Too large to be shown whole here: one element of ${cell.mesh.step} is drawn, larger than it is.`) : null;
    return [canvas, thin];
  }
  /// Once.
  draw() {
    this.drawn = this.drawn || this.drawAll();
    return this.drawn;
  }
  async drawAll() {
    for (const [canvas, cell] of this.canvases) {
      try {
        await this.view.add(canvas, cell.mesh, (cell.closeups || []).map((c) => c.at));
        canvas.dataset.drawn = "yes";
      } catch (error) {
        canvas.replaceWith(el("div", { class: "missing failed" }, `The picture cannot be drawn here: ${error.message}`));
        console.error(error);
      }
    }
  }
}
