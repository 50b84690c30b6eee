/* The flow at any time: particles move in straight lines from one moment to the next. */

const UNCHANGED = 0xffffffff; // no partner in the next moment

class Flow {
  constructor(scene, moments) {
    this.scene = scene;
    this.moments = moments;
    this.dim = scene.packing.lower.length;
    this.start = moments[0].time;
    this.end = moments[moments.length - 1].time;
    this.pair = -1;
    this.most = Math.max(...moments.map((moment) => moment.count));
    /* x, y, z, half size, half size, and place among the colours of each particle: from 0 to 1, or -1 for no value */
    this.rows = new Float32Array(6 * this.most);
    this.count = 0;
  }

  /** Number of the last moment at or before a time, and the part of the way to the next. */
  place(time) {
    let low = 0;
    let high = this.moments.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.moments[middle].time <= time) low = middle;
      else high = middle;
    }
    if (this.moments.length > 1 && time >= this.moments[high].time) return [high, 0];
    const span = high > low ? this.moments[high].time - this.moments[low].time : 1;
    return [low, Math.min(1, Math.max(0, (time - this.moments[low].time) / span))];
  }

  /** The time at which the mean speed of the material is largest. */
  liveliest() {
    let best = 0;
    let time = this.start;
    for (const moment of this.moments) {
      const code = moment.code.speed;
      let sum = 0;
      for (let k = 0; k < code.length; k++) sum += code[k];
      if (sum / code.length > best) [best, time] = [sum / code.length, moment.time];
    }
    return time;
  }

  /** Fill `rows` with the particles at a time, coloured by a quantity. */
  at(time, quantity) {
    const [index, part] = this.place(time);
    const before = this.moments[index];
    const after = this.moments[index + 1] ?? before;
    const partner = this.partners(index);
    const { lower, extent, longest } = this.scene.packing;
    const dim = this.dim;
    const codes = [before.code[quantity], after.code[quantity]];
    const { gaps } = this.scene.quantities.find(({ name }) => name === quantity);
    const grow = (this.grow = Math.pow(before.share, -1 / dim)); // each also fills the volume of those that were left out
    const half = [before.size[0], before.size[before.size.length - 1]];
    for (let k = 0; k < before.count; k++) {
      const row = 6 * k;
      const other = partner ? partner[k] : k;
      const there = other === UNCHANGED ? null : after;
      for (let axis = 0; axis < dim; axis++) {
        const from = before.position[axis][k];
        let step = there ? there.position[axis][other] - from : 0;
        if (this.jumps(axis, step)) step = 0;
        this.rows[row + axis] = lower[axis] + (extent[axis] * (from + part * step)) / 65535;
      }
      if (dim === 2) this.rows[row + 2] = 0;
      this.rows[row + 3] = (grow * longest * half[0][k]) / 255;
      this.rows[row + 4] = (grow * longest * half[1][k]) / 255;
      const first = codes[0][k];
      const last = there ? codes[1][other] : first;
      const nearest = quantity === 'yielded' || (gaps && (first === 0 || last === 0));
      const code = nearest ? (part < 0.5 ? first : last) : first + part * (last - first);
      this.rows[row + 5] = gaps && code === 0 ? -1 : code / 255;
    }
    this.count = before.count;
    return this;
  }

  /** Whether a step crosses a periodic face; 65535 is the whole extent. */
  jumps(axis, step) {
    const period = this.scene.domain.periods[axis];
    return period !== null && (Math.abs(step) / 65535) * this.scene.packing.extent[axis] > period / 2;
  }

  /** For each particle of a moment its index in the next moment; null if both have the same particles. */
  partners(index) {
    if (index === this.pair) return this.partner;
    this.pair = index;
    const a = this.moments[index];
    const b = this.moments[index + 1];
    if (!b || b.same) return (this.partner = null);
    this.partner = new Uint32Array(a.count).fill(UNCHANGED);
    for (let k = 0, other = 0; k < a.count; k++) {
      while (other < b.count && b.number[other] < a.number[k]) other++;
      if (b.number[other] === a.number[k]) this.partner[k] = other;
    }
    return this.partner;
  }
}
