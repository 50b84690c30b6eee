/* Follows a run: asks its server for newer data, and gives a newer page to the page that is shown. */
(() => {
  'use strict';
  const EVERY = 1500; // milliseconds between two questions
  const NOTHING = 'nothing yet';
  let shown = VERSION;

  const said = document.createElement('p');
  said.setAttribute('role', 'status');
  said.style.cssText = 'position: sticky; top: 0; z-index: 9; margin: 0; padding: .25em 1em; background: #0072b2; color: #fff; font: 14px/1.5 system-ui, sans-serif';
  document.body.prepend(said);

  function say(text) {
    said.textContent = text;
  }

  async function update() {
    const answer = await fetch('page.html');
    const html = await answer.text();
    const version = answer.headers.get('X-Version');
    if (version === NOTHING || version === shown) return;
    if (window.mpmkit === undefined) { // the page of a run that is being prepared
      location.reload();
      return;
    }
    await window.mpmkit.take(html);
    shown = version;
    document.documentElement.dataset.version = shown;
  }

  async function follow() {
    try {
      const state = await (await fetch('state.json')).json();
      say(state.time === null ? 'Live: the run is being prepared' : `Live: t = ${state.time.toPrecision(4)} of ${state.until} s`);
      if (state.version !== shown) await update();
      if (state.ended) {
        await fetch('farewell');
        return say(`The run has ended. Its page stays in ${state.directory}/report/index.html.`);
      }
    } catch {
      return say('The run has ended. This page shows its last state.');
    }
    setTimeout(follow, EVERY);
  }

  say('Live');
  follow();
})();
