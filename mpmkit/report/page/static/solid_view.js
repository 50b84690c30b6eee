/* A scene in three dimensions, which turns under the mouse or a finger. */

const ANGLE = 0.6; // of view, rad
const FIRST = { turn: -0.9, rise: 0.35, near: 1.2 };
const KEYS = {
  ArrowLeft: ['turn', 0.1],
  ArrowRight: ['turn', -0.1],
  ArrowUp: ['rise', 0.08],
  ArrowDown: ['rise', -0.08],
};
const FULLER = 1.25; // balls with the volume of their boxes would leave gaps

class SolidView {
  constructor(stage, scene, walls, state) {
    this.stage = stage;
    this.scene = scene;
    this.walls = walls;
    this.images = images(scene.mirrors);
    this.surface = new Surface(stage.querySelector('.material'));
    Object.assign(this, FIRST, state);
    const { lower, upper } = scene.material;
    const low = lower.map((x, a) => (scene.mirrors[a] === null ? x : Math.min(x, 2 * scene.mirrors[a] - upper[a])));
    const high = upper.map((x, a) => (scene.mirrors[a] === null ? x : Math.max(x, 2 * scene.mirrors[a] - lower[a])));
    this.target = low.map((x, a) => (x + high[a]) / 2);
    this.radius = Math.hypot(...low.map((x, a) => high[a] - x)) / 2;
    this.floor = this.floorLines(low, high);
  }

  /** A grid of lines on the floor below the material. */
  floorLines(low, high) {
    const { found } = ticks(0, Math.max(high[0] - low[0], high[1] - low[1]), 8);
    const step = found[1] - found[0];
    const from = [0, 1].map((a) => Math.floor(low[a] / step - 0.5) * step);
    const to = [0, 1].map((a) => Math.ceil(high[a] / step + 0.5) * step);
    const z = this.scene.domain.closed[2][0] ? this.scene.domain.lower[2] : low[2];
    const points = [];
    for (let x = from[0]; x <= to[0] + step / 2; x += step) points.push(x, from[1], z, x, to[1], z);
    for (let y = from[1]; y <= to[1] + step / 2; y += step) points.push(from[0], y, z, to[0], y, z);
    this.step = step;
    return { points: new Float32Array(points), parts: Uint32Array.from({ length: points.length / 3 }, (_, k) => k) };
  }

  draw(flow, quantity, place) {
    const height = Math.max(240, Math.min(0.62 * window.innerHeight, 0.72 * this.stage.clientWidth, 540));
    this.stage.style.height = `${Math.round(height)}px`;
    const { surface } = this;
    surface.clear();
    const { gl, canvas } = surface;
    const aspect = canvas.clientWidth / canvas.clientHeight;
    const distance = (1.05 * this.radius) / Math.sin(ANGLE / 2) / Math.min(1, 1.15 * aspect) / this.near;
    const lens = perspective(ANGLE, aspect, Math.max(distance - 4 * this.radius, 0.02 * distance), distance + 4 * this.radius);
    const view = orbit(this.target, this.turn, this.rise, distance);
    surface.colours(ramp(quantity));
    surface.particles(flow);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const still = motion([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0], [1, 1, 1], [0, 0, 0]);
    const line = channels(styled('--hair')).map((c) => c / 255);
    surface.facet(this.floor, { model: still, view, lens, tint: [...line, 1], lit: 0 }, true);
    for (const { flip, move } of this.images) {
      surface.draw(surface.balls, { flip, move, view, lens, grow: FULLER });
    }
    gl.depthMask(false);
    const tint = channels(styled('--wall')).map((c) => c / 255);
    for (const wall of this.walls) {
      const now = wall.at(place);
      if (!now) continue;
      for (const { flip, move } of this.images) {
        surface.facet(now.shape, { model: motion(now.turn, now.shift, flip, move), view, lens, tint: [...tint, 0.28], lit: 1 });
      }
    }
    gl.depthMask(true);
    this.label();
  }

  /** Write the size of the squares of the floor. */
  label() {
    const canvas = this.stage.querySelector('.over');
    const pen = penOf(canvas);
    pen.font = `12px ${styled('--font')}`;
    pen.fillStyle = styled('--soft');
    pen.textAlign = 'right';
    const side = this.step >= 1 ? `${shown(this.step)} m` : `${shown(1e3 * this.step)} mm`;
    pen.fillText(`squares of ${side}`, canvas.clientWidth - 12, canvas.clientHeight - 12);
  }

  /** No value is read from a ball. */
  under() {
    return null;
  }

  listen(changed) {
    const { stage } = this;
    const pointers = new Map();
    const apart = () => {
      const [a, b] = [...pointers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    stage.classList.add('turns');
    stage.addEventListener('pointerdown', (event) => {
      stage.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    stage.addEventListener('pointermove', (event) => {
      const last = pointers.get(event.pointerId);
      if (!last) return;
      const before = pointers.size === 2 ? apart() : 0;
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (pointers.size === 2) this.zoom(apart() / before);
      else this.rotate(-0.008 * (event.clientX - last.x), 0.008 * (event.clientY - last.y));
      changed();
    });
    for (const kind of ['pointerup', 'pointercancel']) {
      stage.addEventListener(kind, (event) => pointers.delete(event.pointerId));
    }
    stage.addEventListener('wheel', (event) => {
      if (document.activeElement !== stage && !event.ctrlKey) return; // otherwise the page could not scroll past it
      event.preventDefault();
      this.zoom(Math.exp(-0.0015 * event.deltaY));
      changed();
    }, { passive: false });
    stage.addEventListener('dblclick', () => {
      Object.assign(this, FIRST);
      changed();
    });
    stage.addEventListener('keydown', (event) => {
      if (KEYS[event.key]) this.rotate(...(KEYS[event.key][0] === 'turn' ? [KEYS[event.key][1], 0] : [0, KEYS[event.key][1]]));
      else if (event.key === '+' || event.key === '=') this.zoom(1.15);
      else if (event.key === '-') this.zoom(1 / 1.15);
      else return;
      event.preventDefault();
      changed();
    });
  }

  rotate(turn, rise) {
    this.turn += turn;
    this.rise = Math.min(1.55, Math.max(-0.3, this.rise + rise));
  }

  zoom(factor) {
    this.near = Math.min(12, Math.max(0.3, this.near * factor));
  }

  state() {
    return { turn: this.turn, rise: this.rise, near: this.near };
  }
}
