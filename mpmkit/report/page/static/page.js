/* Starts the charts and the player of a page, and updates them while a run is in progress. */

const page = { charts: [], player: null };

/** Put charts and player into their places, from the data of a page. */
async function mount(data) {
  const before = page.player?.state() ?? {};
  page.player?.close();
  page.charts.forEach((chart) => chart.close());
  page.player = null;
  page.charts = [...document.querySelectorAll('[data-chart]')].map((place) => {
    const { charts } = data[place.closest('section').id];
    return new Chart(place, charts[place.dataset.chart], (time) => page.player?.seek(time));
  });
  const root = document.querySelector('[data-player]');
  if (root) await mountPlayer(root, data.flow, before);
  document.documentElement.dataset.ready = 'yes';
}

async function mountPlayer(root, scene, before) {
  if (typeof DecompressionStream === 'undefined') return refuse(root, 'This browser is too old to show the flow: use one of 2023 or later.');
  const moments = await unpacked(scene.packing, scene.blob);
  try {
    page.player = new Player(root, scene, moments, before);
  } catch (error) {
    if (error.message !== 'no WebGL') throw error;
    return refuse(root, 'This browser does not draw with WebGL 2, which the player of the flow needs; the rest of this page works without it.');
  }
  page.player.listeners.push((time) => page.charts.forEach((chart) => chart.mark(time)));
  page.player.show();
}

/** Say why there is no player. */
function refuse(root, sentence) {
  const said = document.createElement('p');
  said.className = 'note';
  said.textContent = sentence;
  root.replaceChildren(said);
}

/** Replace the content by that of a newer page, given as HTML; the player keeps its time. */
async function take(html) {
  const newer = new DOMParser().parseFromString(html, 'text/html');
  document.querySelector('header').replaceWith(newer.querySelector('header'));
  document.querySelector('nav').replaceWith(newer.querySelector('nav'));
  document.querySelector('main').replaceWith(newer.querySelector('main'));
  await mount(JSON.parse(newer.getElementById('data').textContent));
}

window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => page.charts.forEach((chart) => chart.draw()));
window.mpmkit = { page, take };
mount(JSON.parse(document.getElementById('data').textContent));
