/* Reads the moments of a flow; packing.py in the same folder of the sources describes their layout. */

/** Bytes of a text in base64. */
function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

/** Inflates deflated bytes. */
async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * The moments of a flow, in order of time. Each has `time`, `count`, `share`, and arrays of `count` numbers:
 * `number`, `position[axis]` (16 bits), `size[k]` (8 bits), `code[quantity]` (8 bits) and `body`.
 */
async function unpacked(packing, text) {
  const content = await inflated(bytesOf(text));
  let at = 0;

  function take(width, count) {
    const numbers = width === 1 ? new Uint8Array(count) : width === 2 ? new Uint16Array(count) : new Uint32Array(count);
    for (let byte = 0; byte < width; byte++, at += count) {
      for (let k = 0; k < count; k++) numbers[k] |= content[at + k] << (8 * byte);
    }
    return numbers;
  }

  /** One number of each particle, or its change; typed arrays add modulo 2 to the number of bits. */
  function plane(width, count, before) {
    const numbers = take(width, count);
    if (before) for (let k = 0; k < count; k++) numbers[k] += before[k];
    return numbers;
  }

  const moments = [];
  for (const { time, count, same, share } of packing.moments) {
    const last = same ? moments[moments.length - 1] : null;
    const moment = { time, count, share, same, position: [], size: [], code: {} };
    if (same) moment.number = last.number;
    else {
      moment.number = take(4, count);
      for (let k = 1; k < count; k++) moment.number[k] += moment.number[k - 1];
    }
    packing.lower.forEach((_, axis) => moment.position.push(plane(2, count, last?.position[axis])));
    for (let k = 0; k < packing.sizes; k++) moment.size.push(plane(1, count, last?.size[k]));
    for (const name of packing.quantities) moment.code[name] = plane(1, count, last?.code[name]);
    moment.body = plane(1, count, last?.body);
    moments.push(moment);
  }
  return moments;
}
