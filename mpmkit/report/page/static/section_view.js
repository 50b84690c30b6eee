/* The section of a scene in two dimensions, with axes in mm and walls. */

const EDGES = { left: 52, right: 14, top: 12, bottom: 40 };
const REACH = 1; // cells over which a box is spread, to close gaps between boxes that move apart
const SHORTEST = 190;

class SectionView {
  constructor(stage, scene, walls) {
    this.stage = stage;
    this.scene = scene;
    this.walls = walls;
    this.images = images(scene.mirrors);
    this.beyond = this.beyondFaces();
    this.surface = new Surface(stage.querySelector('.material'));
    this.over = stage.querySelector('.over');
    this.limits = this.around();
  }

  /** Lower and upper corner of the view, m: the material at all times, its mirror image, and a margin. */
  around() {
    const { lower, upper } = this.scene.material;
    const low = [...lower];
    const high = [...upper];
    this.scene.mirrors.forEach((plane, axis) => {
      if (plane === null) return;
      [low[axis], high[axis]] = [Math.min(low[axis], 2 * plane - high[axis]), Math.max(high[axis], 2 * plane - low[axis])];
    });
    const largest = Math.max(high[0] - low[0], high[1] - low[1]);
    const room = (this.walls.length ? 0.1 : 0.03) * largest;
    const floor = this.scene.domain.closed[1][0] ? this.scene.domain.lower[1] : low[1] - room;
    return [low[0] - room, Math.min(floor, low[1]), high[0] + room, high[1] + room];
  }

  /** Find the scale, pixels per metre, from the available width, and set the height of the stage. */
  fit() {
    const width = this.stage.clientWidth - EDGES.left - EDGES.right;
    const [x0, y0, x1, y1] = this.limits;
    const tallest = Math.max(SHORTEST, Math.min(0.6 * window.innerHeight, 520));
    this.scale = Math.min(width / (x1 - x0), tallest / (y1 - y0));
    const height = Math.max((y1 - y0) * this.scale, 24);
    this.stage.style.height = `${Math.ceil(height + EDGES.top + EDGES.bottom)}px`;
    this.shift = [EDGES.left + (width - (x1 - x0) * this.scale) / 2 - x0 * this.scale, EDGES.top + height + y0 * this.scale];
  }

  /** Position on the stage, px, of a point, m. */
  place(x, y) {
    return [this.shift[0] + x * this.scale, this.shift[1] - y * this.scale];
  }

  /** Point, m, at a place on the stage. */
  point(px, py) {
    return [(px - this.shift[0]) / this.scale, (this.shift[1] - py) / this.scale];
  }

  draw(flow, quantity, place) {
    this.fit();
    const density = this.surface.clear();
    const { gl, canvas } = this.surface;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const { lower, upper } = this.ends();
    const [left, bottom] = this.place(lower[0], lower[1]);
    const [right, top] = this.place(upper[0], upper[1]);
    gl.enable(gl.SCISSOR_TEST); // the part of a box behind a face is not drawn
    gl.scissor(...[left, height - bottom, right - left, bottom - top].map((length) => Math.round(length * density)));
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    this.surface.colours(ramp(quantity));
    this.surface.particles(flow);
    const scale = [(2 * this.scale) / width, (2 * this.scale) / height];
    const origin = [(2 * this.shift[0]) / width - 1, 1 - (2 * this.shift[1]) / height];
    for (const { flip, move } of this.images) this.surface.draw(this.surface.boxes, { flip, move, scale, origin, grow: 1 });
    const reach = REACH * this.scene.cell * flow.grow;
    this.surface.blend(this.beyond, { scale, origin, reach }, quantity.name === 'yielded');
    this.drawOver(place);
  }

  /** The images, and their images behind the faces: without these, a floor would look like a free surface. */
  beyondFaces() {
    const { lower, upper, closed, periods } = this.scene.domain;
    const found = [...this.images];
    for (const image of this.images) {
      for (const axis of [0, 1]) {
        const moved = (change) => found.push({ flip: [...image.flip], move: [...image.move], ...change });
        [lower[axis], upper[axis]].forEach((face, side) => {
          const set = (list, value) => list.map((old, a) => (a === axis ? value : old));
          if (closed[axis][side]) moved({ flip: set(image.flip, -image.flip[axis]), move: set(image.move, 2 * face - image.move[axis]) });
          else if (periods[axis] !== null) moved({ move: set(image.move, image.move[axis] + (side ? 1 : -1) * periods[axis]) });
        });
      }
    }
    return found;
  }

  /** Corners of the domain with its mirror image. */
  ends() {
    const lower = [...this.scene.domain.lower];
    const upper = [...this.scene.domain.upper];
    this.scene.mirrors.forEach((plane, axis) => {
      if (plane === null) return;
      const far = plane === lower[axis] ? upper[axis] : lower[axis];
      [lower[axis], upper[axis]] = [far, 2 * plane - far].sort((a, b) => a - b);
    });
    return { lower, upper };
  }

  drawOver(place) {
    const under = this.stage.querySelector('.under');
    this.drawAxes(penOf(under), under.clientWidth, under.clientHeight);
    const pen = penOf(this.over);
    this.drawFaces(pen);
    this.drawWalls(pen, place);
  }

  drawAxes(pen, width, height) {
    const large = Math.max(this.limits[2] - this.limits[0], this.limits[3] - this.limits[1]) >= 10;
    const [factor, unit] = large ? [1, 'm'] : [1e3, 'mm'];
    const [x0, y1] = this.point(EDGES.left, EDGES.top);
    const [x1, y0] = this.point(width - EDGES.right, height - EDGES.bottom);
    pen.font = `12px ${styled('--font')}`;
    pen.fillStyle = styled('--soft');
    pen.strokeStyle = styled('--hair');
    pen.lineWidth = 1;
    const across = ticks(x0 * factor, x1 * factor, Math.max(2, width / 110));
    const along = ticks(y0 * factor, y1 * factor, Math.max(1, height / 60));
    pen.beginPath();
    pen.textAlign = 'center';
    pen.textBaseline = 'top';
    for (const value of across.found) {
      const [px] = this.place(value / factor, 0);
      pen.moveTo(Math.round(px) + 0.5, EDGES.top);
      pen.lineTo(Math.round(px) + 0.5, height - EDGES.bottom + 4);
      pen.fillText(value.toFixed(across.digits).replace('-', '−'), px, height - EDGES.bottom + 6);
    }
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    for (const value of along.found) {
      const [, py] = this.place(0, value / factor);
      pen.moveTo(EDGES.left - 4, Math.round(py) + 0.5);
      pen.lineTo(width - EDGES.right, Math.round(py) + 0.5);
      pen.fillText(value.toFixed(along.digits).replace('-', '−'), EDGES.left - 7, py);
    }
    pen.globalAlpha = 0.55;
    pen.stroke();
    pen.globalAlpha = 1;
    pen.textBaseline = 'bottom';
    pen.textAlign = 'center';
    pen.fillText(`${this.scene.axes[0]} (${unit})`, (EDGES.left + width - EDGES.right) / 2, height - 2);
    pen.save();
    pen.translate(11, (EDGES.top + height - EDGES.bottom) / 2);
    pen.rotate(-Math.PI / 2);
    pen.textBaseline = 'middle';
    pen.fillText(`${this.scene.axes[1]} (${unit})`, 0, 0);
    pen.restore();
  }

  /** Lines along the faces of the domain that are walls. */
  drawFaces(pen) {
    const { lower, upper } = this.ends();
    const { closed } = this.scene.domain;
    const corners = [this.place(lower[0], lower[1]), this.place(upper[0], upper[1])];
    const sides = this.scene.mirrors[0] === null ? closed[0] : [closed[0].some(Boolean), closed[0].some(Boolean)];
    pen.save();
    pen.beginPath();
    pen.rect(EDGES.left - 4, EDGES.top - 4, this.over.clientWidth - EDGES.left - EDGES.right + 8, this.over.clientHeight - EDGES.top - EDGES.bottom + 8);
    pen.clip();
    pen.beginPath();
    pen.strokeStyle = styled('--ink');
    pen.lineWidth = 2;
    const line = (a, b, c, d) => { pen.moveTo(a, b); pen.lineTo(c, d); };
    if (closed[1][0]) line(corners[0][0], corners[0][1] + 1, corners[1][0], corners[0][1] + 1);
    if (closed[1][1]) line(corners[0][0], corners[1][1] - 1, corners[1][0], corners[1][1] - 1);
    if (sides[0]) line(corners[0][0] - 1, corners[0][1], corners[0][0] - 1, corners[1][1]);
    if (sides[1]) line(corners[1][0] + 1, corners[0][1], corners[1][0] + 1, corners[1][1]);
    pen.stroke();
    pen.restore();
  }

  drawWalls(pen, place) {
    pen.save();
    pen.beginPath();
    pen.rect(EDGES.left, 0, this.over.clientWidth - EDGES.left - EDGES.right, this.over.clientHeight - EDGES.bottom + 2);
    pen.clip();
    pen.strokeStyle = styled('--wall');
    pen.lineWidth = 2;
    pen.lineCap = 'round';
    for (const wall of this.walls) {
      const now = wall.at(place);
      if (!now) continue;
      const { points, parts } = now.shape;
      const [a, b, c, d] = now.turn;
      pen.beginPath();
      for (const { flip, move } of this.images) {
        for (let k = 0; k < parts.length; k++) {
          const [x, y] = [points[2 * parts[k]], points[2 * parts[k] + 1]];
          const at = this.place(flip[0] * (a * x + b * y + now.shift[0]) + move[0], flip[1] * (c * x + d * y + now.shift[1]) + move[1]);
          if (k % 2) pen.lineTo(...at);
          else pen.moveTo(...at);
        }
      }
      pen.stroke();
    }
    pen.restore();
  }

  /** The value, from 0 to 1 of its scale, and the point at a position on the stage; null without material. */
  under(flow, px, py) {
    const [x, y] = this.point(px, py);
    let best = null;
    let least = 1.5;
    for (const { flip, move } of this.images) {
      for (let row = 0; row < 6 * flow.count; row += 6) {
        const dx = Math.abs(flow.rows[row] * flip[0] + move[0] - x) / flow.rows[row + 3];
        const dy = Math.abs(flow.rows[row + 1] * flip[1] + move[1] - y) / flow.rows[row + 4];
        const away = Math.max(dx, dy);
        if (away < least) [least, best] = [away, flow.rows[row + 5]];
      }
    }
    return best === null ? null : { value: best, point: [x, y] };
  }

  /** A section cannot be turned. */
  listen() {}

  state() {
    return {};
  }
}
