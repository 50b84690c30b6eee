/* Matrices of 4 × 4 by columns, as WebGL has them. */

/** a b */
function times(a, b) {
  const found = new Float32Array(16);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      for (let k = 0; k < 4; k++) found[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return found;
}

/** Perspective with an angle of view, rad, and the distances of the near and far planes. */
function perspective(angle, aspect, near, far) {
  const f = 1 / Math.tan(angle / 2);
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0]);
}

/** View of a target from a distance; the direction is given by its angle about z and above the floor. */
function orbit(target, turn, rise, distance) {
  const [ct, st, cr, sr] = [Math.cos(turn), Math.sin(turn), Math.cos(rise), Math.sin(rise)];
  const right = [-st, ct, 0];
  const up = [-ct * sr, -st * sr, cr];
  const back = [ct * cr, st * cr, sr];
  const dot = (v) => v[0] * target[0] + v[1] * target[1] + v[2] * target[2];
  return new Float32Array([
    right[0], up[0], back[0], 0,
    right[1], up[1], back[1], 0,
    right[2], up[2], back[2], 0,
    -dot(right), -dot(up), -dot(back) - distance, 1,
  ]);
}

/** The motion x → flip (turn x + shift) + move of a wall and its mirror image. */
function motion(turn, shift, flip, move) {
  const found = new Float32Array(16);
  for (let row = 0; row < 3; row++) {
    for (let column = 0; column < 3; column++) found[4 * column + row] = flip[row] * turn[3 * row + column];
    found[12 + row] = flip[row] * shift[row] + move[row];
  }
  found[15] = 1;
  return found;
}
