/* Colours of quantities, and numbers as people read them. */

/** A colour of the page's style, such as '--ink'. */
function styled(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Red, green and blue from 0 to 255 of '#rrggbb'. */
function channels(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
}

const NONE = '#98a2ab'; // of material that has no value

/** 256 colours of a quantity, as bytes of red, green, blue and alpha; with gaps, the first is that of no value. */
function ramp({ name, colours, gaps }) {
  const bytes = new Uint8Array(4 * 256);
  const stops = colours.map(channels);
  const stepped = name === 'yielded';
  const first = gaps ? 1 : 0;
  if (gaps) bytes.set([...channels(NONE), 255]);
  for (let k = first; k < 256; k++) {
    const at = ((k - first) / (255 - first)) * (stops.length - 1);
    const low = stepped ? Math.round(at) : Math.min(Math.floor(at), stops.length - 2);
    for (let c = 0; c < 3; c++) {
      bytes[4 * k + c] = stepped ? stops[low][c] : stops[low][c] + (at - low) * (stops[low + 1][c] - stops[low][c]);
    }
    bytes[4 * k + 3] = 255;
  }
  return bytes;
}

/** Where a place among the colours of a quantity is on its scale, from 0 to 1. */
function partAt({ gaps }, place) {
  return gaps ? (255 * place - 1) / 254 : place;
}

/** Value of a quantity at a part of its scale. */
function valueAt({ low, high, logarithmic }, part) {
  return logarithmic ? low * Math.pow(high / low, part) : low + part * (high - low);
}

/** A number with about `digits` digits; with an exponent only if it is very large or very small. */
function shown(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size < -4 || size >= 7) return value.toExponential(digits - 1).replace('e+', 'e');
  return value.toFixed(Math.max(0, digits - 1 - size)).replace('-', '−');
}

/** About `count` round numbers between two values. */
function ticks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= rough) * power;
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return { found, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

/** The drawing context of an empty canvas, in pixels of the page. */
function penOf(canvas) {
  const density = window.devicePixelRatio || 1;
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight].map((length) => Math.round(length * density));
  const pen = canvas.getContext('2d');
  pen.scale(density, density);
  return pen;
}

/** Draw the colour bar of a quantity, with its numbers, into a canvas. */
function drawBar(canvas, quantity) {
  const width = canvas.clientWidth;
  const pen = penOf(canvas);
  pen.font = `12px ${styled('--font')}`;
  pen.fillStyle = pen.strokeStyle = styled('--soft');
  pen.textBaseline = 'top';
  const [left, right, thick] = [18, width - 18, 10];
  const colours = ramp(quantity);
  const first = quantity.gaps ? 1 : 0;
  const along = (part) => left + part * (right - left);
  if (quantity.name === 'yielded') {
    ['at rest, as a solid', 'flows'].forEach((word, k) => {
      const x = left + k * Math.min(190, (right - left) / 2 + 20);
      pen.fillStyle = quantity.colours[k];
      pen.fillRect(x, 2, 22, thick);
      pen.fillStyle = styled('--ink');
      pen.fillText(word, x + 30, 1);
    });
    return;
  }
  for (let x = left; x < right; x++) {
    const k = 4 * (first + Math.round(((255 - first) * (x - left)) / (right - left)));
    pen.fillStyle = `rgb(${colours[k]},${colours[k + 1]},${colours[k + 2]})`;
    pen.fillRect(x, 2, 1.5, thick);
  }
  const marks = [];
  if (quantity.logarithmic) {
    for (let power = Math.ceil(Math.log10(quantity.low)); Math.pow(10, power) <= quantity.high; power++) {
      marks.push([Math.log10(Math.pow(10, power) / quantity.low) / Math.log10(quantity.high / quantity.low), shown(Math.pow(10, power), 1)]);
    }
  } else {
    const { found, digits } = ticks(quantity.low, quantity.high, width < 420 ? 3 : 6);
    for (const value of found) marks.push([(value - quantity.low) / (quantity.high - quantity.low), value.toFixed(digits).replace('-', '−')]);
  }
  pen.textAlign = 'center';
  pen.fillStyle = styled('--soft');
  for (const [part, text] of marks) {
    pen.fillRect(along(part) - 0.5, 2 + thick, 1, 4);
    pen.fillText(text, along(part), thick + 8);
  }
}
