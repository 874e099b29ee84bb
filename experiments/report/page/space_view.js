// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces, turned together. All are drawn by one WebGL renderer, of which browsers allow only a few.

const kAspect = 1.25;
let sharedRenderer = null;
function renderer() {
  sharedRenderer = sharedRenderer || new THREE.WebGLRenderer({ antialias: true, alpha: true });
  return sharedRenderer;
}

function makeFaces(mesh) {
  const places = [], classes = [];
  const triangle = (ends, colour) => {
    places.push(...ends.flat());
    classes.push(colour, colour, colour);
  };
  eachElement(mesh, (corners, n, at, colour) => {
    const nodes = Array.from({ length: n }, (_, k) => [mesh.x, mesh.y, mesh.z].map((axis) => axis[corners[at + k]]));
    if (n <= 4) {
      for (let k = 1; k + 1 < n; ++k) triangle([nodes[0], nodes[k], nodes[k + 1]], colour);
      return;
    }
    const centre = [0, 1, 2].map((axis) => nodes.reduce((sum, node) => sum + node[axis], 0) / n);  // of a curved one
    nodes.forEach((node, k) => triangle([centre, node, nodes[(k + 1) % n]], colour));
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(places), 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(places.length), 3));
  geometry.computeVertexNormals();
  const faces = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: true, side: 2, polygonOffset: true,
    polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
  faces.userData.classes = classes;
  return faces;
}

/// Gives faces the colours that the palette has now.
function paintFaces(faces) {
  const colours = palette.classes().map((c) => new THREE.Color(c)), grey = new THREE.Color("#d3dae0"), paint = faces.geometry.getAttribute("color");
  faces.userData.classes.forEach((c, i) => {
    const { r, g, b } = c < 0 ? grey : colours[c];
    paint.setXYZ(i, r, g, b);
  });
  paint.needsUpdate = true;
}

function makeSegments(mesh, ends, colour, opacity) {
  const places = new Float32Array(3 * ends.length);
  ends.forEach((v, i) => places.set([mesh.x[v], mesh.y[v], mesh.z[v]], 3 * i));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour, transparent: opacity < 1, opacity }));
}

function edgesOf(mesh) {
  const ends = [], n = mesh.x.length, known = new Set();
  eachElement(mesh, (corners, count, at) => {
    for (let k = 0; k < count; ++k) {
      const a = corners[at + k], b = corners[at + ((k + 1) % count)], key = Math.min(a, b) * n + Math.max(a, b);
      if (known.has(key)) continue;
      known.add(key);
      ends.push(a, b);
    }
  });
  return ends;
}

function meanLength(mesh, ends) {
  let sum = 0;
  for (let i = 0; i < ends.length; i += 2) {
    const [a, b] = [ends[i], ends[i + 1]];
    sum += Math.hypot(mesh.x[a] - mesh.x[b], mesh.y[a] - mesh.y[b], mesh.z[a] - mesh.z[b]);
  }
  return sum / Math.max(1, ends.length / 2);
}

function makeDots(mesh, vertices, colour) {
  const geometry = new THREE.BufferGeometry();
  const places = new Float32Array(vertices.flatMap((v) => [mesh.x[v], mesh.y[v], mesh.z[v]]));
  geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
  return new THREE.Points(geometry, new THREE.PointsMaterial({ color: colour, sizeAttenuation: false }));
}

/// Lines as thin prisms: WebGL draws every line one pixel wide.
function makeStroke(mesh, ends, colour, width) {
  const places = [], at = (v) => new THREE.Vector3(mesh.x[v], mesh.y[v], mesh.z[v]);
  for (let i = 0; i < ends.length; i += 2) {
    const [a, b] = [at(ends[i]), at(ends[i + 1])], along = b.clone().sub(a).normalize();
    const aside = along.clone().cross(Math.abs(along.z) < 0.9 ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(1, 0, 0)).setLength(width);
    const corners = [0, 1, 2].map((k) => aside.clone().applyAxisAngle(along, (2 * Math.PI * k) / 3));
    corners.forEach((p, k) => {
      const q = corners[(k + 1) % 3];
      for (const [end, side] of [[a, p], [b, p], [b, q], [a, p], [b, q], [a, q]]) places.push(...end.clone().add(side).toArray());
    });
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(places), 3));
  geometry.computeVertexNormals();
  return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: colour, emissive: colour, side: 2 }));
}

function makeScene(mesh) {
  const scene = new THREE.Scene(), ends = edgesOf(mesh), edges = makeSegments(mesh, ends, "#1c2430", 0.5), dots = [], faces = makeFaces(mesh);
  paintFaces(faces);
  scene.add(faces, edges, makeSegments(mesh, Array.from(mesh.lines), "#000000", 1), new THREE.AmbientLight("#ffffff", 1.5));
  const byColour = new Map();
  for (const { vertex, valence } of mesh.irregular) {
    const colour = markColour(valence, mesh.regular);
    byColour.set(colour, [...(byColour.get(colour) || []), vertex]);
  }
  for (const [colour, vertices] of byColour) dots.push(makeDots(mesh, vertices, colour));
  dots.push(makeSegments(mesh, Array.from(mesh.pairs), kMarks.pair, 1));  // seen where dots are
  scene.add(...dots);
  for (const { ends, colour } of mesh.strokes || []) scene.add(makeStroke(mesh, ends, colour, 0.08 * meanLength(mesh, ends)));
  return { scene, faces, edges, dots, edge: (meanLength(mesh, ends) * mesh.around) / 4 };
}

const dispose = (scene) => scene.traverse((part) => part.geometry && part.geometry.dispose());

class SpaceView {
  constructor() {
    this.pictures = [];  // {canvas, marks, scene, ...}
    palette.followers.add(this);
    this.light = new THREE.DirectionalLight("#ffffff", 2);
    this.cut = [];  // planes, of which the other side is not drawn
  }
  end() {
    palette.followers.delete(this);
    cancelAnimationFrame(this.waiting);
    for (const { scene } of this.pictures) dispose(scene);
    this.pictures = [];
  }
  repaint() {
    for (const picture of this.pictures) {
      paintFaces(picture.faces);
      this.draw(picture);
    }
  }
  place(mesh) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    [mesh.x, mesh.y, mesh.z].forEach((axis, k) => axis.forEach((v) => {
      low[k] = Math.min(low[k], v);
      high[k] = Math.max(high[k], v);
    }));
    this.middle = new THREE.Vector3(...low.map((v, k) => (v + high[k]) / 2));
    this.radius = Math.hypot(...low.map((v, k) => high[k] - v)) / 2 || 1;
    Object.assign(this, { low, high });
    const r = this.radius;
    this.camera = new THREE.OrthographicCamera(-r, r, r, -r, -10 * r, 30 * r);
    this.camera.up.set(0, 0, 1);
    this.target = this.middle.clone();
    this.first = mesh;
    this.start();
  }
  start() {
    this.target.copy(this.middle);
    this.camera.position.copy(this.middle).add(new THREE.Vector3(1, -1.4, 0.9).setLength(10 * this.radius));
    this.camera.lookAt(this.target);
    this.camera.updateMatrixWorld();
    let wide = 0, high = 0;
    const p = new THREE.Vector3();
    for (let i = 0; i < this.first.x.length; ++i) {
      p.set(this.first.x[i], this.first.y[i], this.first.z[i]).applyMatrix4(this.camera.matrixWorldInverse);
      wide = Math.max(wide, Math.abs(p.x));
      high = Math.max(high, Math.abs(p.y));
    }
    this.camera.zoom = 0.94 * this.radius * Math.min(kAspect / (wide || 1), 1 / (high || 1));
  }
  reset() {
    this.start();
    this.redraw();
  }
  zoomBy(factor) {
    this.camera.zoom = Math.min(1e4, Math.max(0.3, this.camera.zoom * factor));
    this.redraw();
  }
  /// Turns by 10 degrees about the vertical or the picture's own horizontal.
  move(right, up) {
    const away = this.camera.position.clone().sub(this.target), step = Math.PI / 18;
    const around = Math.atan2(away.y, away.x) + right * step;
    const above = Math.min(1.5, Math.max(-1.5, Math.asin(away.z / away.length()) + up * step));
    const flat = Math.cos(above);
    this.camera.position.copy(this.target).add(new THREE.Vector3(flat * Math.cos(around), flat * Math.sin(around), Math.sin(above)).setLength(away.length()));
    this.redraw();
  }
  /// The plane at a part of the box, 0 to 1, across an axis, 0 to 2. Its negative side is nearer to the eye.
  planeAt(axis, part) {
    const at = this.low[axis] + part * (this.high[axis] - this.low[axis]);
    const away = this.camera.position.getComponent(axis) > this.target.getComponent(axis) ? -1 : 1;
    return { normal: new THREE.Vector3().setComponent(axis, away), constant: -away * at };
  }
  /// Hides the negative side of a plane; null: of none.
  cutAt(plane) {
    this.cut = plane ? [plane] : [];
    this.redraw();
  }
  lookAt(at, size, away) {
    this.target.set(...at);
    this.camera.position.copy(this.target).add(new THREE.Vector3(...away).setLength(10 * this.radius));
    this.camera.zoom = Math.max(1, this.radius / (14 * size));
    this.redraw();
  }
  /// Returns the source of a figure.
  add(canvas, mesh, marks) {
    if (!this.camera) this.place(mesh);
    canvas.style.aspectRatio = kAspect;
    const picture = { canvas, marks, ...makeScene(mesh) };
    this.pictures.push(picture);
    const controls = new THREE.OrbitControls(this.camera, canvas);
    controls.enableZoom = controls.enablePan = false;
    controls.target = this.target;
    canvas.style.touchAction = "";  // as the style sheet says
    controls.addEventListener("change", () => this.redraw());
    listenToZoom(canvas, this);
    this.draw(picture);
    redrawWhenResized(canvas, this);
    return this.source(picture);
  }
  /// As it is turned now; as an image in every format.
  source(picture) {
    const canvas = () => {
      const { clientWidth: width, clientHeight: height } = picture.canvas, image = el("canvas");
      this.drawOn(image, picture, width, height, kDotsAcross / width);
      return image;
    };
    const drawing = () => {
      const [width, height] = [picture.canvas.clientWidth, picture.canvas.clientHeight];
      return standalone(svg("svg", { viewBox: `0 0 ${width} ${height}` }, svg("image", { width, height, href: canvas().toDataURL() })));
    };
    return { canvas, drawing };
  }
  /// What its only picture shows from now on.
  show(mesh) {
    const [picture] = this.pictures;
    dispose(picture.scene);
    Object.assign(picture, makeScene(mesh));
    this.redraw();
  }
  redraw() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = null;
      for (const picture of this.pictures) this.draw(picture);
    });
  }
  draw(picture) {
    const { clientWidth: width, clientHeight: height } = picture.canvas;
    if (width && height) this.drawOn(picture.canvas, picture, width, height, window.devicePixelRatio || 1);
  }
  /// In pixels of the page, with so many dots to each.
  drawOn(canvas, { marks, scene, edges, dots: points, edge }, wide0, high0, dots) {
    const width = Math.round(wide0 * dots), height = Math.round(high0 * dots);
    const { camera, radius } = this, wide = width / height;
    [camera.left, camera.right, camera.top, camera.bottom] = [-radius * Math.max(1, wide), radius * Math.max(1, wide),
      radius * Math.max(1, 1 / wide), -radius * Math.max(1, 1 / wide)];
    camera.lookAt(this.target);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.light.position.copy(camera.position).sub(this.target);
    scene.add(this.light);
    const pixels = (edge * camera.zoom * wide0) / (camera.right - camera.left);
    edges.material.opacity = Math.min(0.6, pixels / 12);
    for (const p of points) {
      p.material.size = dots * Math.min(7, 0.4 * pixels);
      p.visible = pixels > 2.5;
    }
    const gl = renderer();
    gl.setSize(width, height, false);
    gl.clippingPlanes = this.cut;
    gl.render(scene, camera);
    canvas.width = width;
    canvas.height = height;
    const pen = canvas.getContext("2d");
    pen.drawImage(gl.domElement, 0, 0);
    pen.scale(dots, dots);
    marks.forEach((at, i) => {
      if (!at || this.cut.some(({ normal, constant }) => normal.dot(new THREE.Vector3(...at)) + constant < 0)) return;
      const p = new THREE.Vector3(...at).project(camera);
      drawPin(pen, ((p.x + 1) / 2) * wide0, ((1 - p.y) / 2) * high0, i + 1, wide0);
    });
  }
}
