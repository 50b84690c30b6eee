/* Walls: their drawings, and their positions at a time. */

class Wall {
  constructor(data, dim) {
    this.name = data.name;
    this.dim = dim;
    this.places = data.places;
    this.shapes = data.shapes.map(({ points, parts }) => ({
      points: new Float32Array(bytesOf(points).buffer),
      parts: new Uint32Array(bytesOf(parts).buffer),
    }));
  }

  /** Drawing, rotation (by rows) and shift between two moments; null if the wall is not present. */
  at([index, part]) {
    const from = this.places[index];
    const to = this.places[index + 1] ?? from;
    const shape = this.shapes[from[0]];
    if (!shape) return null;
    const share = to[0] === from[0] ? part : 0;
    const numbers = from.slice(1).map((value, k) => value + share * (to[k + 1] - value));
    const n = this.dim * this.dim;
    return { shape, turn: numbers.slice(0, n), shift: numbers.slice(n) };
  }
}
