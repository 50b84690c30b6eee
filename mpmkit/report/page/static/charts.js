/* Charts with a cursor that reads values, drawn by uPlot. */

const HEIGHT = 260;

/** Colours of curves, from the style of the page; colour-blind readers can distinguish them. */
function curveColours() {
  return [1, 2, 3, 4, 5, 6, 7, 8].map((k) => styled(`--curve-${k}`));
}

class Chart {
  /**
   * `place` is an element; `seek` is called with the time of a click.
   * `data` has title, unit, x, xLabel, xUnit, curves of label and values; it may be logarithmic and have a band,
   * or be one of points that have names.
   */
  constructor(place, data, seek) {
    this.place = place;
    this.data = data;
    this.seek = seek;
    this.timed = data.xLabel === 'time';
    place.replaceChildren();
    const title = document.createElement('figcaption');
    title.textContent = data.unit ? `${data.title} (${data.unit})` : data.title;
    this.reading = document.createElement('output');
    this.reading.className = 'values';
    this.reading.setAttribute('aria-live', 'off');
    this.plot = document.createElement('div');
    this.plot.className = 'plot';
    this.plot.tabIndex = 0;
    this.plot.setAttribute('role', 'img');
    this.plot.setAttribute('aria-label', `${place.getAttribute('aria-label')}. Arrow keys read values.`);
    place.append(title, this.plot, this.reading);
    this.draw();
    this.listen();
  }

  draw() {
    this.u?.destroy();
    const { data } = this;
    this.u = new uPlot(this.options(), [data.x, ...data.curves.map((curve) => curve.values)], this.plot);
    this.now = document.createElement('div');
    this.now.className = 'now';
    this.u.over.append(this.now);
    this.say(null);
    if (this.time !== undefined) this.mark(this.time);
  }

  options() {
    const { data } = this;
    const colours = curveColours();
    const [ink, hair] = [styled('--soft'), styled('--hair')];
    const font = `12px ${styled('--font')}`;
    const axis = { stroke: ink, font, labelFont: font, grid: { stroke: hair, width: 1 }, ticks: { stroke: hair, width: 1, size: 4 } };
    if (data.logarithmic && !data.names) axis.grid.filter = (_, splits) => splits.map((value) => (isPower(value) ? value : null));
    if (data.logarithmic) axis.values = (_, splits) => splits.map((value) => (value === null ? '' : power(value)));
    else axis.values = (_, splits, __, ___, step) => splits.map((value) => value.toFixed(decimals(step)).replace('-', '−'));
    const scale = data.logarithmic ? { distr: 3 } : {};
    return {
      width: this.width(),
      height: HEIGHT,
      legend: { show: false },
      scales: { x: { time: false, ...scale, ...(data.names ? { range: decades } : {}) }, y: { ...scale, range: data.logarithmic ? decades : roomy } },
      axes: [
        { ...axis, label: data.xUnit ? `${data.xLabel} (${data.xUnit})` : data.xLabel, labelSize: 20, size: 30 },
        { ...axis, size: 62 },
      ],
      series: [{}, ...data.curves.map((curve, k) => this.series(curve, colours[k % colours.length], k))],
      cursor: {
        y: false,
        sync: this.timed ? { key: 'time' } : undefined,
        points: { size: 8 },
        drag: { x: true, y: false, setScale: true },
        bind: { dblclick: (u, _, act) => act },
      },
      hooks: {
        setCursor: [(u) => this.say(u.cursor.idx)],
        drawClear: [(u) => this.drawBand(u)],
        draw: [() => this.now && this.time !== undefined && this.mark(this.time)], // also if a part is enlarged
      },
    };
  }

  series(curve, colour, number) {
    const look = { label: curve.label, stroke: colour, width: 2, dash: number >= 8 ? [6, 4] : undefined, spanGaps: false, points: { show: false } };
    if (curve.points) return { ...look, paths: () => null, points: { show: true, size: 10, fill: colour, stroke: styled('--paper'), width: 1.5 } };
    return look;
  }

  width() {
    return Math.max(200, this.plot.clientWidth);
  }

  /** Shade the range of shear rates that was reached, and mark its end. */
  drawBand(u) {
    const { band } = this.data;
    if (!band) return;
    const { ctx, bbox } = u;
    const x = (value) => u.valToPos(value, 'x', true);
    ctx.save();
    ctx.fillStyle = styled('--band');
    ctx.fillRect(x(band.from), bbox.top, Math.max(2, x(band.to) - x(band.from)), bbox.height);
    ctx.strokeStyle = styled('--soft');
    ctx.setLineDash([4, 4]);
    ctx.beginPath();
    ctx.moveTo(x(band.most), bbox.top);
    ctx.lineTo(x(band.most), bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  /** Show the values of a row below the chart; of the last row if none is given. */
  say(row) {
    const { data } = this;
    const at = row ?? (this.data.names ? null : data.x.length - 1);
    this.row = at;
    const parts = [];
    if (at !== null) {
      if (data.names) parts.push(part('', data.names[at], ''));
      parts.push(part('', `${data.xLabel} ${shown(data.x[at], 4)} ${data.xUnit}`, ''));
    }
    data.curves.forEach((curve, k) => {
      const value = at === null ? null : curve.values[at];
      if (at !== null && value === null && data.names) return;
      parts.push(part(curveColours()[k % 8], curve.label, at === null ? '' : `${shown(value, 4)} ${data.unit}`));
    });
    this.reading.replaceChildren(...parts);
  }

  /** Show the time of the player. */
  mark(time) {
    if (!this.timed) return;
    this.time = time;
    const left = this.u.valToPos(time, 'x');
    this.now.style.display = left >= 0 && left <= this.u.over.clientWidth ? 'block' : 'none';
    this.now.style.transform = `translateX(${left}px)`;
  }

  /** Put the cursor on a row. */
  moveTo(row) {
    const last = this.data.x.length - 1;
    const at = Math.min(last, Math.max(0, row));
    this.u.setCursor({ left: this.u.valToPos(this.data.x[at], 'x'), top: 10 });
  }

  listen() {
    this.plot.addEventListener('keydown', (event) => {
      this.reading.setAttribute('aria-live', 'polite'); // for screen readers
      const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -20, PageDown: 20 }[event.key];
      if (event.key === 'Home') this.moveTo(0);
      else if (event.key === 'End') this.moveTo(this.data.x.length - 1);
      else if (event.key === 'Enter') this.choose();
      else if (step) this.moveTo((this.row ?? 0) + step);
      else return;
      event.preventDefault();
    });
    let from = null;
    this.plot.addEventListener('pointerdown', (event) => { from = event.clientX; });
    this.plot.addEventListener('pointerup', (event) => {
      if (from !== null && Math.abs(event.clientX - from) < 4 && event.target.closest('.u-over')) this.choose();
      from = null;
    });
    this.watch = new ResizeObserver(() => {
      if (this.width() === this.u.width) return;
      this.u.setSize({ width: this.width(), height: HEIGHT });
    });
    this.watch.observe(this.plot);
  }

  choose() {
    if (this.timed && this.row !== null) this.seek(this.data.x[this.row]);
  }

  close() {
    this.watch.disconnect();
    this.u.destroy();
  }
}

/** A label, with the colour of its curve, and a value. */
function part(colour, label, value) {
  const element = document.createElement('span');
  if (colour) {
    const dot = document.createElement('i');
    dot.style.background = colour;
    element.append(dot);
  }
  element.append(label);
  if (value) {
    const strong = document.createElement('b');
    strong.textContent = value;
    element.append(' ', strong);
  }
  return element;
}

/** Whether a value is a whole power of ten. */
function isPower(value) {
  const exponent = Math.log10(value);
  return Math.abs(exponent - Math.round(exponent)) < 1e-6;
}

/** A power of ten as 10ⁿ, or as a plain number if it is short; empty for other values. */
function power(value) {
  if (!isPower(value)) return shown(value, 1);
  const n = Math.round(Math.log10(value));
  if (n >= -2 && n <= 4) return String(Number(value.toPrecision(1)));
  return `10${String(n).replace('-', '⁻').replace(/\d/g, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[digit])}`;
}

/** Decimals that a step needs. */
function decimals(step) {
  for (let digits = 0; digits < 9; digits++) {
    const whole = step * Math.pow(10, digits);
    if (Math.abs(whole - Math.round(whole)) < 1e-6 * whole) return digits;
  }
  return 9;
}

/** Whole powers of ten around values. */
function decades(_, low, high) {
  if (!(low > 0)) return [0.1, 10];
  const [from, to] = [Math.floor(Math.log10(low) + 1e-9), Math.ceil(Math.log10(high) - 1e-9)];
  return [Math.pow(10, from), Math.pow(10, Math.max(to, from + 1))];
}

/** The range of values with a margin; it starts at 0 if no value is negative. */
function roomy(_, low, high) {
  if (low === null || high === null) return [0, 1];
  if (low === high) return low === 0 ? [0, 1] : low > 0 ? [0, 1.2 * high] : [1.2 * low, 0];
  const least = 0.02 * Math.max(Math.abs(low), Math.abs(high)); // small fluctuations must not fill the chart
  if (high - low < least) return [(low + high - least) / 2, (low + high + least) / 2];
  const room = 0.06 * (high - low);
  const near = low >= 0 && low < 0.6 * high;
  return [near ? 0 : low - room, high <= 0 && high > 0.6 * low ? 0 : high + room];
}
