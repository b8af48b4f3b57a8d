// Waypoints over the scene: moved by the pointer on their own level, or by the arrow keys by a metre, with Shift by ten.

import { say } from './link.js';
import { onLevel } from './scene.js';

const EVERY = 100;  // ms between two words about a place
const STEPS = { ArrowUp: [0, 1], ArrowDown: [0, -1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

let held = null, told = 0;
const round = value => Math.round(value * 100) / 100;

function move(handle, x, y, last) {
  Object.assign(handle.dataset, { x, y });
  if (!last && performance.now() - told < EVERY) return;
  told = performance.now();
  say(...JSON.parse(handle.dataset.move), round(x), round(y));
}

document.addEventListener('pointerdown', event => {
  const handle = event.target.closest?.('#gcs .g-handle');
  if (!handle || event.button !== 0) return;
  event.preventDefault();
  handle.setPointerCapture(event.pointerId);
  held = handle;
  handle.dataset.held = 'yes';
});
document.addEventListener('pointermove', event => {
  const at = held && onLevel(event.clientX, event.clientY, Number(held.dataset.z));
  if (at) move(held, ...at, false);
});
for (const type of ['pointerup', 'pointercancel']) document.addEventListener(type, event => {
  if (!held) return;
  const at = onLevel(event.clientX, event.clientY, Number(held.dataset.z));
  if (at) move(held, ...at, true);
  const let_go = held;
  setTimeout(() => delete let_go.dataset.held, 400);  // by then the ground station shows it where it was put
  held = null;
});
document.addEventListener('keydown', event => {
  const handle = event.target.closest?.('#gcs .g-handle'), step = STEPS[event.key];
  if (!handle || !step) return;
  event.preventDefault();
  event.stopPropagation();
  const by = event.shiftKey ? 10 : 1;
  move(handle, Number(handle.dataset.x) + by * step[0], Number(handle.dataset.y) + by * step[1], true);
}, true);
