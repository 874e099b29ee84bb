// SPDX-License-Identifier: GPL-3.0-or-later
// A pen like that of a canvas which makes an SVG drawing.

class SvgPen {
  constructor(width, height) {
    this.node = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height });
    this.lineWidth = 1;
    this.beginPath();
  }
  beginPath() {
    this.steps = [];
    this.circle = null;
    this.drawn = null;  // what this path has become
  }
  at(x, y) {
    return `${Number(x.toFixed(2))} ${Number(y.toFixed(2))}`;
  }
  moveTo(x, y) {
    this.steps.push(`M${this.at(x, y)}`);
  }
  lineTo(x, y) {
    this.steps.push(`L${this.at(x, y)}`);
  }
  closePath() {
    this.steps.push("Z");
  }
  /// Whole circles only.
  arc(cx, cy, r) {
    this.circle = { cx, cy, r };
  }
  shape() {
    if (this.drawn) return this.drawn;
    if (!this.circle && this.steps.length === 0) return null;
    this.drawn = this.circle ? svg("circle", this.circle) : svg("path", { d: this.steps.join("") });
    for (const name of ["fill", "stroke"]) this.drawn.setAttribute(name, "none");
    this.node.append(this.drawn);
    return this.drawn;
  }
  fill() {
    const shape = this.shape();
    if (shape) shape.setAttribute("fill", this.fillStyle);
  }
  stroke() {
    const shape = this.shape();
    if (!shape) return;
    shape.setAttribute("stroke", this.strokeStyle);
    shape.setAttribute("stroke-width", Number(this.lineWidth.toFixed(3)));
    shape.setAttribute("stroke-linejoin", "round");
  }
  /// Bold, centred on the place.
  fillText(text, x, y) {
    this.node.append(svg("text", { x, y: y + 4, "font-size": 11, "font-weight": "bold", "text-anchor": "middle", fill: this.fillStyle }, String(text)));
  }
}
