// Driving by hand: keys, buttons and a gamepad say which way is held, again and again; what is not said any more is let go.

import { say } from './link.js';

const EVERY = 100;  // ms
const DEAD_ZONE = 0.12, HOLD_BUTTON = 5;  // of a gamepad: RB is held while it drives

const wheel = () => document.querySelector('#gcs-wheel[data-driver="mine"]');
const held = new Map();  // the key or pointer that holds it -> [forward, turn, aside]
let drove = false, gone = false;

function stick() {
  if (gone || !navigator.getGamepads) return null;
  const pad = [...navigator.getGamepads()].find(pad => pad && pad.buttons[HOLD_BUTTON]?.pressed);
  if (!pad) return null;
  const [aside = 0, forward = 0, turn = 0] = pad.axes.map(axis => Math.abs(axis) < DEAD_ZONE ? 0 : -axis);
  return [forward, turn, aside];
}

function steer() {
  if (!wheel()) held.clear();
  const pad = wheel() && stick();
  if (pad) held.set('gamepad', pad); else held.delete('gamepad');
  if (!held.size && !drove) return;
  const way = [0, 1, 2].map(i => Math.max(-1, Math.min(1, [...held.values()].reduce((sum, one) => sum + Number(one[i]), 0))));
  drove = held.size > 0;
  say('steer', ...way);
}
setInterval(steer, EVERY);

const hold = (by, button) => { held.set(by, button.dataset.steer.split(' ')); steer(); };
const release = by => { const was = held.delete(by); if (was) steer(); return was; };
const releaseAll = () => { if (held.size) { held.clear(); steer(); } };
export const typing = event => event.target.closest?.('input,textarea,select,[contenteditable]');

window.addEventListener('keydown', event => {
  const panel = wheel();
  if (!panel || event.ctrlKey || event.altKey || event.metaKey || typing(event)) return;
  if (event.key === 'Escape') { releaseAll(); say('leave-wheel'); return; }
  const presses = key => panel.querySelector(`[data-keys~="${CSS.escape(key)}"]`);
  const button = presses(event.key) ?? (event.key.length === 1 ? presses(event.key.toLowerCase()) : null);
  if (!button) return;
  event.preventDefault();
  event.stopImmediatePropagation();  // viser's own keys would move the view
  if (!button.dataset.steer) button.click();
  else if (!held.has(event.code)) hold(event.code, button);  // a held key is repeated: it drives on after the panel or the window was away
}, true);
window.addEventListener('keyup', event => { if (release(event.code)) event.stopImmediatePropagation(); }, true);
window.addEventListener('pointerdown', event => {
  const button = wheel() && event.button === 0 && event.target.closest?.('#gcs-wheel [data-steer]');
  if (button) { event.preventDefault(); hold('pointer' + event.pointerId, button); }
}, true);
for (const type of ['pointerup', 'pointercancel']) window.addEventListener(type, event => release('pointer' + event.pointerId), true);
for (const type of ['blur', 'pagehide']) window.addEventListener(type, () => { gone = true; releaseAll(); steer(); });
window.addEventListener('focus', () => { gone = false; });
document.addEventListener('visibilitychange', () => { gone = document.hidden; if (gone) releaseAll(); });
