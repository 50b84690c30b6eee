/* Plots of a history, drawn anew whenever the run has written more of it. */

const EVERY = 1500; // milliseconds between two questions
const SHOWN = ['spread_diameter', 'height', 'max_speed', 'kinetic_energy', 'potential_energy', 'time_step'];
const [WIDTH, HEIGHT, LEFT, BELOW] = [340, 180, 58, 22];

function ends(values) {
  const finite = values.filter((value) => value !== null);
  const [low, high] = [Math.min(...finite), Math.max(...finite)];
  return high > low ? [low, high] : [low - 0.5 * Math.abs(low || 1), high + 0.5 * Math.abs(high || 1)];
}

function plot(time, one, until) {
  const [low, high] = ends(one.values);
  const x = (t) => LEFT + (WIDTH - LEFT - 4) * t / until;
  const y = (value) => (HEIGHT - BELOW) * (1 - (value - low) / (high - low)) + 4;
  const line = one.values.map((value, i) => (value === null ? '' : `L${x(time[i]).toFixed(1)},${y(value).toFixed(1)}`)).join('').replace(/^L/, 'M');
  const tick = (value) => `<line x1="${LEFT}" x2="${WIDTH}" y1="${y(value)}" y2="${y(value)}"/><text x="${LEFT - 4}" y="${y(value) + 4}" text-anchor="end">${value.toPrecision(3)}</text>`;
  const figure = document.createElement('figure');
  figure.innerHTML = `<figcaption></figcaption><svg viewBox="0 0 ${WIDTH} ${HEIGHT}" role="img">${[low, (low + high) / 2, high].map(tick).join('')}`
    + `<text x="${LEFT}" y="${HEIGHT}">0</text><text x="${WIDTH}" y="${HEIGHT}" text-anchor="end">${until} s</text><path d="${line}"/></svg>`;
  figure.firstChild.textContent = `${one.label} (${one.unit})`;
  return figure;
}

function show(history) {
  const last = history.time.at(-1);
  if (last === undefined) return say('The run has not written anything yet: it is being prepared.');
  say(`t = ${last.toPrecision(4)} of ${history.until} s`);
  document.getElementById('progress').value = last / history.until;
  const names = SHOWN.filter((name) => history.series[name]?.values.some((value) => value !== null));
  document.getElementById('plots').replaceChildren(...names.map((name) => plot(history.time, history.series[name], history.until)));
  document.documentElement.dataset.rows = history.time.length;
}

function say(text) {
  document.getElementById('state').textContent = text;
}

let shown = data.version;

async function follow() {
  try {
    const state = await (await fetch('state.json')).json();
    if (state.version !== shown) {
      const history = await (await fetch('history.json')).json();
      shown = history.version;
      show(history);
    }
    if (state.ended) {
      await fetch('farewell');
      return say(`The run has ended. Its results are in ${state.directory}.`);
    }
  } catch {
    return say('The run has ended.');
  }
  setTimeout(follow, EVERY);
}

show(data);
follow();
