// Keys of the whole page; those for driving by hand are in driving.js, and come first.

import { typing } from './driving.js';
import { say } from './link.js';

const VIEWS = { f: 'Follow', t: 'Top', Home: 'All' };

window.addEventListener('keydown', event => {
  if (event.key === 'Escape' && event.shiftKey) {
    say('stop');
    event.preventDefault();
    return;
  }
  if (typing(event) || event.ctrlKey || event.altKey || event.metaKey || event.repeat) return;
  if (document.querySelector('#gcs-wheel[data-driver="mine"]')) return;
  const card = /^[1-9]$/.test(event.key) && document.querySelectorAll('#gcs .g-card')[Number(event.key) - 1];
  const view = VIEWS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (card) card.click();
  else if (event.key === 'Escape') say('point', '');
  else if (view) say('view', view);
  else if (event.key === '?') document.getElementById('tab-help').click();
  else return;
  event.preventDefault();
  event.stopPropagation();
}, true);
