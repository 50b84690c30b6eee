/* The player: time, speed of playing, and the quantity that gives the colours. */

const LASTS = 8; // seconds that a run takes by default to play
const FACTORS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

/** The playback speed in words. */
function pace(factor) {
  if (factor === 1) return 'real time';
  return factor < 1 ? `${Math.round(1 / factor)} × slower` : `${factor} × faster`;
}

class Player {
  /** `before` is the state of the player that this one replaces. */
  constructor(root, scene, moments, before = {}) {
    this.root = root;
    this.scene = scene;
    this.flow = new Flow(scene, moments);
    const walls = scene.walls.map((wall) => new Wall(wall, this.flow.dim));
    this.stage = root.querySelector('.stage');
    this.view = this.flow.dim === 2 ? new SectionView(this.stage, scene, walls) : new SolidView(this.stage, scene, walls, before.view);
    this.slider = root.querySelector('.time');
    this.clock = root.querySelector('.clock');
    this.button = root.querySelector('.play');
    this.paces = root.querySelector('.pace select');
    this.listeners = [];
    this.playing = false;
    this.time = before.time ?? this.flow.liveliest();
    this.choose(before.quantity ?? scene.quantities[0].name);
    this.fillPaces(before.factor);
    this.listen();
    this.show();
  }

  get quantity() {
    return this.scene.quantities.find((quantity) => quantity.name === this.name);
  }

  get factor() {
    return Number(this.paces.value);
  }

  state() {
    return { time: this.time, quantity: this.name, factor: this.factor, view: this.view.state() };
  }

  choose(name) {
    this.name = this.scene.quantities.some((quantity) => quantity.name === name) ? name : this.scene.quantities[0].name;
    for (const choice of this.root.querySelectorAll('[name=colour]')) choice.checked = choice.value === this.name;
    const { label, unit, meaning } = this.quantity;
    this.root.querySelector('.meaning').textContent = `${label}${unit ? ` (${unit})` : ''}: ${meaning}.`;
  }

  fillPaces(chosen) {
    const wanted = (this.flow.end - this.flow.start) / LASTS || 1;
    const nearest = FACTORS.reduce((a, b) => (Math.abs(Math.log(b / wanted)) < Math.abs(Math.log(a / wanted)) ? b : a));
    const usual = wanted > 0.25 && wanted < 2 ? 1 : nearest;
    const at = FACTORS.indexOf(usual);
    const offered = new Set([...FACTORS.slice(Math.max(0, at - 4), at + 4), 1, chosen ?? usual]);
    this.paces.replaceChildren(...[...offered].sort((a, b) => a - b).map((factor) => {
      const option = document.createElement('option');
      option.value = factor;
      option.textContent = pace(factor);
      return option;
    }));
    this.paces.value = chosen ?? usual;
  }

  listen() {
    this.stopped = new AbortController();
    const { signal } = this.stopped;
    const on = (target, kind, act) => target.addEventListener(kind, act, { signal });
    on(this.slider, 'input', () => {
      this.pause();
      this.seek(this.flow.start + (this.slider.value / 1000) * (this.flow.end - this.flow.start));
    });
    on(this.button, 'click', () => (this.playing ? this.pause() : this.play()));
    for (const choice of this.root.querySelectorAll('[name=colour]')) {
      on(choice, 'change', () => { this.choose(choice.value); this.show(); });
    }
    on(this.stage, 'keydown', (event) => {
      if (event.key !== ' ') return;
      event.preventDefault();
      this.button.click();
    });
    on(this.stage, 'pointermove', (event) => this.read(event));
    on(this.stage, 'pointerleave', () => { this.stage.querySelector('.reading').textContent = ''; });
    on(window, 'resize', () => this.show());
    on(window.matchMedia('(prefers-color-scheme: dark)'), 'change', () => this.show());
    this.view.listen(() => this.show());
  }

  /** Stop for good: another player replaces this one. */
  close() {
    this.pause();
    this.stopped.abort();
  }

  play() {
    if (this.time >= this.flow.end) this.time = this.flow.start;
    this.playing = true;
    this.button.textContent = '❚❚';
    this.button.setAttribute('aria-label', 'Pause');
    let last = performance.now();
    const advance = (now) => {
      if (!this.playing) return;
      this.time = Math.min(this.flow.end, this.time + (this.factor * (now - last)) / 1000);
      last = now;
      this.show();
      if (this.time >= this.flow.end) this.pause();
      else requestAnimationFrame(advance);
    };
    requestAnimationFrame(advance);
  }

  pause() {
    this.playing = false;
    this.button.textContent = '▶';
    this.button.setAttribute('aria-label', 'Play');
  }

  seek(time) {
    this.time = Math.min(this.flow.end, Math.max(this.flow.start, time));
    this.show();
  }

  show() {
    const { flow, quantity, time } = this;
    this.view.draw(flow.at(time, this.name), quantity, flow.place(time));
    drawBar(this.root.querySelector('.bar canvas'), quantity);
    const span = flow.end - flow.start || 1;
    this.slider.value = Math.round((1000 * (time - flow.start)) / span);
    const digits = Math.max(0, 3 - Math.floor(Math.log10(span)) - 1);
    this.clock.textContent = `t = ${time.toFixed(digits)} s`;
    this.slider.setAttribute('aria-valuetext', this.clock.textContent);
    for (const tell of this.listeners) tell(time);
  }

  /** Show the value under the pointer. */
  read(event) {
    const box = this.stage.getBoundingClientRect();
    const found = this.view.under(this.flow, event.clientX - box.left, event.clientY - box.top);
    const reading = this.stage.querySelector('.reading');
    if (!found) return void (reading.textContent = '');
    const { quantity } = this;
    const where = found.point.map((x, axis) => `${this.scene.axes[axis]} = ${shown(1e3 * x)} mm`).join(', ');
    const part = partAt(quantity, found.value);
    const value = valueAt(quantity, part);
    const beyond = part >= 1 ? 'at least ' : quantity.logarithmic && part <= 0 ? 'at most ' : '';
    let what = `${beyond}${shown(value)} ${quantity.unit}`.trim();
    if (quantity.name === 'yielded') what = found.value > 0.5 ? 'flows' : 'at rest, as a solid';
    if (found.value < 0) what = 'no value';
    reading.textContent = `${what} · ${where}`;
  }
}
