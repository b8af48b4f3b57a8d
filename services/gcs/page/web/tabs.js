// The tabs on the right: which one is open is this page's own; the ground station draws only that one.

import { fill, on, say } from './link.js';

// Each with the slots that its panel consists of.
const TABS = {
  fly: ['Fly', 'instrument', 'cameras', 'picture', 'trends', 'facts'],
  plan: ['Plan', 'plan'],
  drive: ['Drive', 'instrument', 'wheel', 'mapping', 'cameras', 'picture', 'facts'],
  plot: ['Plot', 'plot'],
  graph: ['Graph', 'graph', 'wiring', 'topics', 'processes'],
  log: ['Log', 'log'],
  run: ['Run', 'run'],
  help: ['Help', 'help'],
};
const BY_KIND = { fixed_wing: 'fly', ground: 'drive' };
const list = document.querySelector('#gcs [role=tablist]'), panels = document.querySelector('#gcs .tabs');
let open = '';

for (const [name, [label, ...slots]] of Object.entries(TABS)) {
  const tab = Object.assign(document.createElement('button'), { type: 'button', id: `tab-${name}`, textContent: label });
  tab.setAttribute('role', 'tab');
  tab.setAttribute('aria-controls', `panel-${name}`);
  tab.addEventListener('click', () => show(name));
  list.append(tab);
  const panel = Object.assign(document.createElement('div'), { id: `panel-${name}`, tabIndex: 0, hidden: true });
  panel.setAttribute('role', 'tabpanel');
  panel.setAttribute('aria-labelledby', tab.id);
  panel.dataset.name = name;
  for (const slot of slots) panel.append(Object.assign(document.createElement('div'), { className: 'part' })), panel.lastChild.dataset.slot = slot;
  panels.append(panel);
}

export const opened = () => open;

export function show(name) {
  if (!(name in TABS)) return;
  open = name;
  for (const tab of list.children) {
    const is = tab.id === `tab-${name}`;
    tab.setAttribute('aria-selected', is);
    tab.tabIndex = is ? 0 : -1;
  }
  for (const panel of panels.children) {
    panel.hidden = panel.dataset.name !== name;
    for (const slot of panel.children) if (panel.hidden) slot.replaceChildren(); else fill(slot);  // nothing stands twice in the page
  }
  say('tab', name);
}

list.addEventListener('keydown', event => {
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  const at = [...list.children].findIndex(tab => tab.id === `tab-${open}`);
  const next = event.key === 'Home' ? 0 : event.key === 'End' ? list.children.length - 1 : step ? (at + step + list.children.length) % list.children.length : -1;
  if (next < 0) return;
  event.preventDefault();
  list.children[next].click();
  list.children[next].focus();
});

// Another vehicle of another kind on show: Fly gives way to Drive and the other way round; other tabs stay.
let kind = '';
on('slot', (name, slot) => {
  if (name !== 'bar') return;
  const now = slot.querySelector('.g-shown')?.dataset.kind || '';
  if (!now || now === kind) return;
  kind = now;
  if (open === '' || open === 'fly' || open === 'drive') show(BY_KIND[kind]);
});
