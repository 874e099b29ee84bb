// SPDX-License-Identifier: GPL-3.0-or-later
// Planar meshes on canvases that show the same part of the plane.

/// What drawing needs again and again: elements by colour and by size, sizes around vertices.
function prepareForPlane(mesh) {
  const byColour = new Map(), bySize = new Map(), around = new Float64Array(mesh.x.length);
  const push = (map, key, value) => (map.has(key) ? map.get(key).push(value) : map.set(key, [value]));
  const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity), most = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
  const box = [least(mesh.x), least(mesh.y), most(mesh.x), most(mesh.y)];
  eachElement(mesh, (corners, n, at, colour) => {
    let area = 0;
    for (let k = 0; k < n; ++k) {
      const a = corners[at + k], b = corners[at + ((k + 1) % n)];
      area += mesh.x[a] * mesh.y[b] - mesh.x[b] * mesh.y[a];
    }
    const size = Math.sqrt(Math.abs(area) / 2) || 1e-300, element = n === 3 ? at : -at - 1;  // quads below zero
    push(byColour, colour, element);
    push(bySize, Math.round(2 * Math.log2(size)), element);
    for (let k = 0; k < n; ++k) around[corners[at + k]] = size;
  });
  return { mesh, byColour, bySize, around, box };
}

/// Elements drawn as one path: with all of them, browsers take very long.
const kAtOnce = 128;

class PlaneView {
  constructor() {
    this.pictures = [];  // {canvas, prepared, marks}
    this.box = null;
    this.reset();
    palette.followers.add(this);
  }
  end() {
    palette.followers.delete(this);
    cancelAnimationFrame(this.waiting);
    this.pictures = [];
  }
  reset() {
    this.zoom = 1;
    this.centre = null;
    this.redraw();
  }
  zoomBy(factor) {
    this.zoom = Math.min(1e5, Math.max(0.5, this.zoom * factor));
    this.redraw();
  }
  /// Shows a place and `size` around it.
  lookAt(at, size) {
    this.centre = [at[0], at[1]];
    this.zoom = Math.max(1, Math.max(this.box[2] - this.box[0], this.box[3] - this.box[1]) / (24 * size));
    this.redraw();
  }
  /// By a tenth of the picture.
  move(right, up) {
    const { canvas } = this.pictures[0], { width, height, scale, centre } = this.frame(canvas);
    this.centre = [centre[0] + (0.1 * right * width) / scale, centre[1] + (0.1 * up * height) / scale];
    this.redraw();
  }
  /// Returns the source of a figure.
  add(canvas, mesh, marks) {
    const prepared = prepareForPlane(mesh);
    this.box = this.box || prepared.box;
    const [x0, y0, x1, y1] = this.box;
    canvas.style.aspectRatio = 1 / Math.min(1.15, Math.max(0.45, (y1 - y0) / (x1 - x0 || 1)));
    this.pictures.push({ canvas, prepared, marks });
    this.listen(canvas);
    const picture = this.pictures[this.pictures.length - 1];
    this.draw(picture);
    redrawWhenResized(canvas, this);
    return this.source(picture);
  }
  /// What its only picture shows from now on.
  show(mesh) {
    this.pictures[0].prepared = prepareForPlane(mesh);
    this.redraw();
  }
  listen(canvas) {
    const down = new Set();  // two fingers zoom
    let last = null;
    canvas.addEventListener("pointerdown", (e) => {
      down.add(e.pointerId);
      last = down.size === 1 ? [e.clientX, e.clientY] : null;
      canvas.setPointerCapture(e.pointerId);
    });
    canvas.addEventListener("pointermove", (e) => {
      if (!last) return;
      const { scale, centre } = this.frame(canvas);
      this.centre = [centre[0] - (e.clientX - last[0]) / scale, centre[1] + (e.clientY - last[1]) / scale];
      last = [e.clientX, e.clientY];
      this.redraw();
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (e) => {
      down.delete(e.pointerId);
      last = null;
    });
    listenToZoom(canvas, this);
  }
  redraw() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = null;
      for (const picture of this.pictures || []) this.draw(picture);
    });
  }
  frame(canvas) {
    const [x0, y0, x1, y1] = this.box, width = canvas.clientWidth, height = canvas.clientHeight;
    const fit = 0.95 * Math.min(width / (x1 - x0 || 1), height / (y1 - y0 || 1));
    return { width, height, scale: fit * this.zoom, centre: this.centre || [(x0 + x1) / 2, (y0 + y1) / 2] };
  }
  /// At once, for paper and after a change of colours.
  repaint() {
    for (const picture of this.pictures) this.draw(picture);
  }
  draw(picture) {
    const { canvas } = picture, frame = this.frame(canvas);
    if (frame.width) this.drawOn(canvas, picture, frame, window.devicePixelRatio || 1, canvas);
  }
  /// `of`: the node whose colours, light or dark, count.
  drawOn(canvas, picture, frame, dots, of) {
    canvas.width = Math.round(frame.width * dots);
    canvas.height = Math.round(frame.height * dots);
    // willReadFrequently keeps the canvas on the CPU: with so many paths some GPUs take a minute.
    const pen = canvas.getContext("2d", { willReadFrequently: true });
    pen.scale(dots, dots);
    this.drawWith(pen, picture, frame, of);
  }
  /// The part of the plane that is seen now, as figures to save.
  source(picture) {
    const drawing = () => {
      const frame = this.frame(picture.canvas), pen = new SvgPen(frame.width, frame.height);
      onPaper(pen.node, () => this.drawWith(pen, picture, frame, pen.node.parentNode));
      return pen.node;
    };
    return { drawing: () => standalone(drawing()) };
  }
  drawWith(pen, { prepared, marks }, { width, height, scale, centre }, of) {
    const { mesh } = prepared, colours = palette.classes();
    const [edge, line, triangle] = ["--mesh-edge", "--mesh-line", "--mesh-triangle"].map((name) => themed(of.tagName === "CANVAS" ? of.parentNode : of, name));
    const x = (v) => width / 2 + (mesh.x[v] - centre[0]) * scale, y = (v) => height / 2 - (mesh.y[v] - centre[1]) * scale;
    const paint = (elements, fills) => {
      pen.beginPath();
      let waiting = 0;
      for (const element of elements) {
        const [corners, n, at] = element >= 0 ? [mesh.triangles, 3, element] : [mesh.quads, mesh.around, -element - 1], across = at + Math.max(2, n >> 1);
        const x0 = x(corners[at]), y0 = y(corners[at]), x2 = x(corners[across]), y2 = y(corners[across]);
        const room = 2 * (Math.abs(x2 - x0) + Math.abs(y2 - y0)) + 4;
        if (x0 < -room || y0 < -room || x0 > width + room || y0 > height + room) continue;
        pen.moveTo(x0, y0);
        for (let k = 1; k < n; ++k) pen.lineTo(x(corners[at + k]), y(corners[at + k]));
        pen.closePath();
        if (++waiting < kAtOnce) continue;
        if (fills) pen.fill();
        pen.stroke();
        pen.beginPath();
        waiting = 0;
      }
      if (fills) pen.fill();
      pen.stroke();
    };
    for (const [colour, elements] of prepared.byColour) {
      pen.fillStyle = pen.strokeStyle = colour < 0 ? triangle : colours[colour];
      pen.lineWidth = 0.4;
      paint(elements, true);
    }
    pen.strokeStyle = edge;
    for (const [step, elements] of prepared.bySize) {
      const size = 2 ** (step / 2) * scale;
      if (size < 2) continue;  // edges would only blacken the picture
      pen.lineWidth = Math.min(1.2, 0.06 * size);
      paint(elements, false);
    }
    this.drawLines(pen, mesh.lines, x, y, line, 1);
    for (const { ends, colour } of mesh.strokes || []) this.drawLines(pen, ends, x, y, colour, 3);
    const dots = mesh.irregular.map(({ vertex }) => Math.min(5, 0.2 * prepared.around[vertex] * scale));
    const mean = dots.reduce((sum, r) => sum + r, 0) / (dots.length || 1);
    if (mean >= 0.4) this.drawLines(pen, mesh.pairs, x, y, kMarks.pair, 0.8 * mean);
    mesh.irregular.forEach(({ vertex, valence }, i) => {
      if (dots[i] < 0.4) return;
      pen.fillStyle = markColour(valence, mesh.regular);
      pen.beginPath();
      pen.arc(x(vertex), y(vertex), dots[i], 0, 7);
      pen.fill();
    });
    marks.forEach((at, i) => at && drawPin(pen, width / 2 + (at[0] - centre[0]) * scale, height / 2 - (at[1] - centre[1]) * scale, i + 1, width));
  }
  drawLines(pen, ends, x, y, colour, width) {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    for (let i = 0; i < ends.length; i += 2) {
      pen.moveTo(x(ends[i]), y(ends[i]));
      pen.lineTo(x(ends[i + 1]), y(ends[i + 1]));
    }
    pen.stroke();
  }
}

/// A number in a circle beside the place it names, towards the middle of the picture.
function drawPin(pen, x, y, number, width) {
  const side = x > width - 24 ? -1 : 1, below = y < 24 ? -1 : 1;
  pen.strokeStyle = pen.fillStyle = "#b3001b";
  pen.lineWidth = 1.4;
  pen.beginPath();
  pen.moveTo(x, y);
  pen.lineTo(x + 9 * side, y - 9 * below);
  pen.stroke();
  pen.beginPath();
  pen.arc(x + 14 * side, y - 14 * below, 7.5, 0, 7);
  pen.fill();
  pen.fillStyle = "#fff";
  pen.font = "bold 11px sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(number, x + 14 * side, y - 14 * below + 0.5);
}
