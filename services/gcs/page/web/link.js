// How the page speaks with the ground station: words go out through a hidden field of viser's, markup comes in as templates.

import { morph } from './morph.js';

const SILENT = 3000;  // ms without a beat after which the link counts as lost
const STALL = 400;  // ms that one look may take: a page that stood still itself has yet to read what came meanwhile

let bridge = '', count = 0;
const newest = new Map(), listeners = { open: [], slot: [] };

export const on = (what, listener) => listeners[what].push(listener);

export function say(...word) {
  const page = window.__viserMutable;
  if (!bridge || !page) return false;
  page.sendMessage({ type: 'GuiUpdateMessage', uuid: bridge, updates: { value: JSON.stringify([++count, ...word]) } });
  return true;
}

let beat = '', silent = 0, looked = performance.now(), dead = false;

function hear(template) {
  if (template.dataset.slot === 'bar') {
    if (template.dataset.beat !== beat) { beat = template.dataset.beat; silent = 0; say('beat', beat); }
    if (template.dataset.bridge !== bridge) { bridge = template.dataset.bridge; listeners.open.forEach(told => told()); }
  }
  newest.set(template.dataset.slot, template.content);
  for (const slot of document.querySelectorAll(`#gcs [data-slot="${template.dataset.slot}"]`)) if (!slot.closest('[role=tabpanel][hidden]')) fill(slot);
}

// Brings a slot of the page to the newest markup for it.
export function fill(slot) {
  const content = newest.get(slot.dataset.slot);
  if (!content) return;
  morph(slot, content.cloneNode(true));
  listeners.slot.forEach(told => told(slot.dataset.slot, slot));
}

new MutationObserver(changes => {
  for (const change of changes) for (const node of change.addedNodes) {
    if (node.nodeType !== 1) continue;
    if (node.nodeName === 'TEMPLATE' && node.dataset.slot) hear(node);
    else for (const template of node.querySelectorAll('template[data-slot]')) hear(template);
  }
}).observe(document.getElementById('root'), { childList: true, subtree: true });

setInterval(() => {
  const now = performance.now();
  silent += Math.min(now - looked, STALL);
  looked = now;
  dead = beat !== '' && silent > SILENT;
  document.getElementById('gcs-dead').hidden = !dead;
  document.getElementById('gcs').classList.toggle('dead', dead);
}, 200);

document.hasFocus = () => true;  // viser connects again only while it has the focus; a page on a second screen never would
