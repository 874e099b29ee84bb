// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes as experiments/report/packed_mesh.h packs them.

const kEtaClasses = 128;

async function inflate(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function unpackMesh(info) {
  const { buffer } = await inflate(document.getElementById(info.id).textContent);
  const around = 4 * info.order;  // of a quad
  let at = 0;
  const take = (count, Type = Uint32Array) => new Type(buffer, 4 * ((at += count) - count), count);
  const entities = (count) => (info.entities ? take(count) : null);
  const [x, y, z] = info.origin.map((origin) => Float64Array.from(take(info.points, Float32Array), (beyond) => origin + beyond));
  const triangles = take(3 * info.triangles), quads = take(around * info.quads), eta = take(info.quads), lines = take(2 * info.lines);
  const irregular = Array.from({ length: info.irregular }, () => take(2)).map(([vertex, valence]) => ({ vertex, valence }));
  const pairs = take(2 * info.pairs), triangleRegion = entities(info.triangles), quadRegion = entities(info.quads), lineCurve = entities(info.lines);
  const cells = info.cells > 0 ? { faceCells: take(2 * (info.triangles + info.quads)), cellAt: take(3 * info.cells, Float32Array),
    cellShape: take(info.cells), cellClass: take(info.cells) } : {};
  return { ...cells, x, y, z, triangles, quads, around, eta, lines, irregular, pairs, regular: info.quads > 0 ? 4 : 6, triangleRegion,
    quadRegion, lineCurve };
}

/// Calls visit(corners, number of corners, place of the first, colour class or -1) for each element.
function eachElement(mesh, visit) {
  for (let i = 0; i < mesh.triangles.length; i += 3) visit(mesh.triangles, 3, i, mesh.ofTriangles ? mesh.ofTriangles[i / 3] : -1);
  for (let i = 0; i < mesh.quads.length; i += mesh.around) visit(mesh.quads, mesh.around, i, mesh.eta[i / mesh.around]);
}
