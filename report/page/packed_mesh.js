// Meshes as report/packed_mesh.h packs them.

const kEtaClasses = 128;

async function inflate(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

class NumberReader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
    this.used = 0;  // vertices that have a number
  }
  next() {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = this.bytes[this.at++];
      value |= (byte & 127) << shift;
      if (byte < 128) return value;
    }
  }
  signed() {
    const value = this.next();
    return value & 1 ? -((value + 1) / 2) : value / 2;
  }
  vertices(count) {
    const result = new Uint32Array(count);
    for (let i = 0; i < count; ++i) {
      const back = this.next();
      result[i] = back === 0 ? this.used++ : this.used - back;
    }
    return result;
  }
}

async function unpackMesh(info) {
  const reader = new NumberReader(await inflate(document.getElementById(info.id).textContent));
  const around = 4 * info.order;  // of a quad
  const triangles = reader.vertices(3 * info.triangles), quads = reader.vertices(around * info.quads);
  const eta = Uint8Array.from({ length: info.quads }, () => reader.next());
  const lines = reader.vertices(2 * info.lines);
  const irregular = Array.from({ length: info.irregular }, () => ({ vertex: reader.next(), valence: reader.next() }));
  const pairs = Uint32Array.from({ length: 2 * info.pairs }, () => reader.next());
  const axes = [];
  for (let k = 0; k < info.dimension; ++k) {
    let at = 0;
    axes.push(Float64Array.from({ length: info.points }, () => info.origin[k] + (at += reader.signed()) * info.unit));
  }
  const [x, y, z = new Float64Array(info.points)] = axes;
  const entities = (n) => (info.entities ? Uint32Array.from({ length: n }, () => reader.next()) : null);
  return { x, y, z, triangles, quads, around, eta, lines, irregular, pairs, regular: info.quads > 0 ? 4 : 6,
    triangleRegion: entities(info.triangles), quadRegion: entities(info.quads), lineCurve: entities(info.lines) };
}

/// Calls visit(corners, number of corners, place of the first, colour class or -1) for each element.
function eachElement(mesh, visit) {
  for (let i = 0; i < mesh.triangles.length; i += 3) visit(mesh.triangles, 3, i, mesh.ofTriangles ? mesh.ofTriangles[i / 3] : -1);
  for (let i = 0; i < mesh.quads.length; i += mesh.around) visit(mesh.quads, mesh.around, i, mesh.eta[i / mesh.around]);
}
