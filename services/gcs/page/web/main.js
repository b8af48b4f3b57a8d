// What runs in the page besides viser: the frame of panels, what is clicked and typed in them, and what is told on connecting.

import { on, say } from './link.js';
import { opened, show } from './tabs.js';
import './driving.js';
import './graph.js';
import './chart.js';
import { shape } from './scene.js';
import './handles.js';
import './keys.js';

const root = document.documentElement;
const stored = (key, value) => { try { if (value !== undefined) localStorage.setItem(key, value); return localStorage.getItem(key) || ''; } catch { return ''; } };

function dress(theme) {
  root.dataset.theme = theme;
  say('theme', theme);
}
dress(stored('gcs-theme') || (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'));
document.getElementById('gcs-theme').addEventListener('click', () => dress(stored('gcs-theme', root.dataset.theme === 'dark' ? 'light' : 'dark')));

for (const button of document.querySelectorAll('#gcs [data-fold]')) button.addEventListener('click', () => {
  const folded = document.body.classList.toggle(`no-${button.dataset.fold}`);
  button.setAttribute('aria-pressed', !folded);
  window.dispatchEvent(new Event('resize'));
});

const table = document.getElementById('gcs-table');
const tell_table = () => say('fleet-table', table.getAttribute('aria-pressed') === 'true');
table.addEventListener('click', () => { table.setAttribute('aria-pressed', table.getAttribute('aria-pressed') !== 'true'); tell_table(); });

let operator = stored('gcs-operator');
if (!/^[0-9a-f]{32}$/.test(operator)) {
  operator = [...crypto.getRandomValues(new Uint8Array(16))].map(byte => byte.toString(16).padStart(2, '0')).join('');
  stored('gcs-operator', operator);
}

// The vehicle on show here: after a lost connection it is asked for again.
let vehicle = '';
on('slot', (name, slot) => { if (name === 'bar') vehicle = slot.querySelector('.g-shown')?.dataset.name || vehicle; });
on('open', () => {
  say('hello', operator, vehicle);
  say('theme', root.dataset.theme);
  if (opened()) say('tab', opened());
  tell_table();
  shape(true);
});

const LONGEST = 54000, TOO_LONG = 48001;  // bytes that a word can carry; characters that the ground station calls too many

const word = element => JSON.parse(element.dataset.do);
document.addEventListener('click', event => {
  const button = event.target.closest('#gcs [data-do]');
  if (!button || ['INPUT', 'SELECT', 'FORM', 'TEXTAREA'].includes(button.nodeName)) return;
  if (button.dataset.tab) show(button.dataset.tab);
  say(...word(button));
});
document.addEventListener('change', async event => {  // a file is read here and told as text
  const field = event.target.closest('#gcs [data-file]'), file = field?.files[0];
  if (!file) return;
  const text = await file.text(), long = new TextEncoder().encode(JSON.stringify(JSON.stringify(text))).length > LONGEST;
  say(...JSON.parse(field.dataset.file), file.name.slice(0, 64), long ? ' '.repeat(TOO_LONG) : text);
  field.value = '';
});
document.addEventListener('change', event => {
  const field = event.target.closest('#gcs [data-do]');
  if (!field || !['INPUT', 'SELECT', 'TEXTAREA'].includes(field.nodeName)) return;
  const value = field.type === 'checkbox' ? field.checked : field.type === 'number' || field.type === 'range' ? field.valueAsNumber : field.value;
  say(...word(field), value);
});
for (const [type, held] of [['pointerdown', 'yes'], ['pointerup', '']]) document.addEventListener(type, event => {  // a slider stays under the pointer
  if (event.target.matches?.('#gcs input[type=range]')) setTimeout(() => held ? event.target.dataset.held = held : delete event.target.dataset.held, held ? 0 : 400);
});
document.addEventListener('input', event => {  // a slider steers while it is drawn, a list follows what is searched for as it is typed
  const field = event.target;
  if (field.matches?.('#gcs input[type=range][data-do]')) say(...word(field), field.valueAsNumber);
  else if (field.matches?.('#gcs input[type=search][data-do]')) say(...word(field), field.value);
});
document.addEventListener('submit', event => {
  event.preventDefault();
  if (event.target.dataset.do) say(...word(event.target), Object.fromEntries(new FormData(event.target)));
});

document.body.dataset.log = 'notice';
document.addEventListener('click', event => {
  const filter = event.target.closest('#gcs [data-log]');
  if (filter) document.body.dataset.log = filter.dataset.log;
});

setInterval(() => {
  const camera = document.getElementById('gcs-cameras');
  if (camera && !document.hidden && camera.getClientRects().length) say('looks');
}, 1000);

document.title = 'UVF ground station';
