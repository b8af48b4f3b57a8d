// The tab Graph: the list follows what is typed as it is typed; boxes and bundles of the drawn graph are pressed by the keyboard like buttons.

import { say } from './link.js';

document.addEventListener('input', event => {
  if (event.target.matches?.('#gcs input[data-key=topics-text]')) say('topics-text', event.target.value);
});

document.addEventListener('keydown', event => {
  if (event.key !== 'Enter' && event.key !== ' ') return;
  const drawn = event.target.closest?.('#gcs svg [role=button][data-do]');
  if (!drawn) return;
  event.preventDefault();
  drawn.dispatchEvent(new MouseEvent('click', { bubbles: true }));
});
