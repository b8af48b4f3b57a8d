// The 3-D view: its shape is told to the ground station, it follows a vehicle, and what belongs to a place in the world stays over it.

import { on, say } from './link.js';

const LEAST = 30;  // px: a vehicle is drawn no smaller than this, wherever it is looked at from
const MOST = { fixed_wing: 40, ground: 6 };  // times its own size
const page = () => window.__viserMutable;
const vehicles = () => document.querySelector('#gcs .g-then') ? '/past/vehicles/' : '/vehicles/';

let touched = false, told = '', following = false;
const hand = event => { if (page() && event.target === page().canvas && (event.type === 'wheel' || event.buttons)) touched = true; };
for (const type of ['wheel', 'pointermove']) document.addEventListener(type, hand, { capture: true, passive: true });

export function shape(anew = false) {
  const canvas = page()?.canvas;
  if (!canvas) return;
  const box = canvas.getBoundingClientRect(), seen = (box.width / Math.max(box.height, 1)).toFixed(3) + touched;
  if ((seen !== told || anew) && say('shape', box.width / Math.max(box.height, 1), touched)) told = seen;
}
setInterval(shape, 200);
setInterval(() => shape(true), 2000);

on('slot', (name, slot) => {
  if (name !== 'views') return;
  const now = slot.querySelector('[aria-pressed=true]')?.textContent, at = slot.querySelector('[data-views]')?.dataset.views || '';
  if (at !== slot.dataset.at) { slot.dataset.at = at; touched = false; }  // a view that was chosen counts as not turned by hand
  following = now === 'Follow';
});

export function project(x, y, z) {
  const { camera, canvas } = page(), root = window.__viserSceneTree.getState()[''];
  const [w, a, b, c] = root.wxyz, tx = 2 * (b * z - c * y), ty = 2 * (c * x - a * z), tz = 2 * (a * y - b * x);
  const point = camera.position.clone().set(x + w * tx + (b * tz - c * ty), y + w * ty + (c * tx - a * tz), z + w * tz + (a * ty - b * tx));
  point.project(camera);
  const box = canvas.getBoundingClientRect();
  return { x: box.left + (point.x + 1) / 2 * box.width, y: box.top + (1 - point.y) / 2 * box.height, ahead: point.z < 1 };
}

// Where the ray through a point of the window [px] meets the level z [m]: [x, y] in the world, or null.
export function onLevel(px, py, z) {
  const { camera, canvas } = page(), box = canvas.getBoundingClientRect();
  const far = camera.position.clone().set((px - box.left) / box.width * 2 - 1, 1 - (py - box.top) / box.height * 2, 0.5).unproject(camera);
  const eye = world(camera.position), through = world(far), down = through[2] - eye[2];
  const way = (z - eye[2]) / down;
  if (!Number.isFinite(way) || way <= 0) return null;
  return [eye[0] + way * (through[0] - eye[0]), eye[1] + way * (through[1] - eye[1])];
}

// From the renderer's axes into the world's: the turn of viser's root node undone.
function world(point) {
  const [w, a, b, c] = window.__viserSceneTree.getState()[''].wxyz, { x, y, z } = point;
  const tx = 2 * (c * y - b * z), ty = 2 * (a * z - c * x), tz = 2 * (b * x - a * y);
  return [x + w * tx + (c * ty - b * tz), y + w * ty + (a * tz - c * tx), z + w * tz + (b * tx - a * ty)];
}

// What has data-x, data-y, data-z hangs at that place of the world [m].
function hang() {
  for (const handle of document.querySelectorAll('#gcs .g-handle')) {
    const at = project(Number(handle.dataset.x), Number(handle.dataset.y), Number(handle.dataset.z)), box = page().canvas.getBoundingClientRect();
    handle.style.visibility = at.ahead ? 'visible' : 'hidden';
    handle.style.transform = `translate(calc(${(at.x - box.left).toFixed(1)}px - 50%), calc(${(at.y - box.top).toFixed(1)}px - 50%))`;
  }
  for (const label of document.querySelectorAll('#gcs .g-menu[data-x]')) {
    const at = project(Number(label.dataset.x), Number(label.dataset.y), Number(label.dataset.z || 0));
    const box = page().canvas.getBoundingClientRect(), seen = at.ahead && at.x > box.left && at.x < box.right && at.y > box.top && at.y < box.bottom;
    label.style.visibility = seen ? 'visible' : 'hidden';
    const left = Math.min(at.x - box.left, box.width - label.offsetWidth - 8), up = at.y - box.top > box.height - label.offsetHeight - 24;
    label.style.transform = `translate(${Math.max(left, 4)}px, ${at.y - box.top + (up ? -label.offsetHeight - 10 : 10)}px)`;
  }
}

// Its own size [m], as it is drawn: of the largest of its meshes.
function sizeOf(node) {
  let size = 0;
  node.traverse(part => {
    if (!part.geometry) return;
    if (!part.geometry.boundingSphere) part.geometry.computeBoundingSphere();
    size = Math.max(size, 2 * part.geometry.boundingSphere.radius);
  });
  return size;
}

function enlarge() {
  const { camera, nodeRefFromName, canvas } = page();
  for (const card of document.querySelectorAll('#gcs .g-card')) {
    const node = nodeRefFromName[vehicles() + card.dataset.name], size = node && sizeOf(node);
    if (!size) continue;
    const away = camera.position.distanceTo(node.getWorldPosition(node.position.clone()));
    const px = size / (2 * away * Math.tan(camera.fov * Math.PI / 360)) * canvas.clientHeight;
    const factor = Math.min(Math.max(LEAST / px, 1), MOST[card.dataset.kind] || 1);
    if (Math.abs(factor - node.scale.x) > 0.02 * factor) { node.scale.setScalar(factor); page().requestRender(); }
  }
}

// A vehicle outside of the view has a sign at the edge where it is: pressed, it brings the vehicle into view, as an alarm about it does.
const signs = document.getElementById('gcs-signs');
document.getElementById('gcs').addEventListener('click', event => {
  const sign = event.target.closest('.g-sign, button.g-alarm');
  if (sign) { say('select', sign.dataset.name); say('view', 'Follow'); }
});

function point() {
  const { camera, nodeRefFromName, canvas } = page(), wide = canvas.clientWidth, high = canvas.clientHeight, seen = new Set();
  for (const card of document.querySelectorAll('#gcs .g-card')) {
    const node = nodeRefFromName[vehicles() + card.dataset.name];
    if (!node) continue;
    const at = node.getWorldPosition(node.position.clone()), away = camera.position.distanceTo(at);
    const eye = at.clone().applyMatrix4(camera.matrixWorldInverse), place = at.clone().project(camera);
    if (eye.z < 0 && Math.abs(place.x) < 0.98 && Math.abs(place.y) < 0.98) continue;
    seen.add(card.dataset.name);
    const flat = Math.hypot(eye.x, eye.y) || 1, x = eye.x / flat, y = -eye.y / flat;
    const reach = Math.min((wide / 2 - 70) / Math.max(Math.abs(x), 1e-6), (high / 2 - 60) / Math.max(Math.abs(y), 1e-6));
    show(card, Math.atan2(y, x), [wide / 2 + x * reach, high / 2 + y * reach], away);
  }
  for (const sign of [...signs.children]) if (!seen.has(sign.dataset.name)) sign.remove();
}

function show(card, angle, [x, y], away) {
  const { name } = card.dataset;
  let sign = [...signs.children].find(sign => sign.dataset.name === name);
  if (!sign) {
    sign = Object.assign(document.createElement('button'), { type: 'button', className: 'g-sign', title: `Bring ${name} into view` });
    sign.dataset.name = name;
    sign.append(Object.assign(document.createElement('i'), { textContent: '➤' }), document.createElement('span'));
    signs.append(sign);
  }
  sign.style.setProperty('--c', card.style.getPropertyValue('--c'));
  sign.firstChild.style.transform = `rotate(${angle}rad)`;
  const words = `${name} ${away < 10 ? away.toFixed(1) : away.toFixed(0)} m`;
  if (sign.lastChild.textContent !== words) sign.lastChild.textContent = words;
  sign.style.transform = `translate(calc(${x.toFixed(0)}px - 50%), calc(${y.toFixed(0)}px - 50%))`;
}

let last = null;
function follow() {
  const chosen = document.querySelector('#gcs-bar .g-shown'), control = page().cameraControl;
  const node = chosen && page().nodeRefFromName[vehicles() + chosen.dataset.name];
  if (!following || !control || !node) { last = null; return; }
  const at = node.getWorldPosition(node.position.clone());
  const eye = control.getPosition(at.clone()), target = control.getTarget(at.clone());
  const turned = touched && last && last.name === chosen.dataset.name;  // else the distance holds, whatever moved the view
  const move = at.clone().sub(turned ? last.at : target);
  if (!turned) eye.sub(target).setLength(Number(chosen.dataset.distance)).add(target);
  eye.add(move);
  target.add(move);
  control.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, false);
  control.update(0.001);  // now, not with the next frame: where frames are slow the vehicle has gone on by then
  last = { name: chosen.dataset.name, at };
}

function frame() {
  requestAnimationFrame(frame);
  if (!page()?.canvas || !page().camera || !window.__viserSceneTree?.getState()['']) return;
  follow();
  enlarge();
  point();
  hang();
}
frame();
