// The words beside a recorded scene, as they were at the moment that viser's player is at.

document.documentElement.dataset.theme = 'light';

function tell() {
  const slider = document.querySelector('#root [role=slider]');
  if (!slider) return;
  const t = Number(slider.getAttribute('aria-valuenow')), words = {};
  for (const [at, told] of CAPTIONS) if (at <= t + 1e-3) Object.assign(words, told);
  for (const slot of document.querySelectorAll('#gcs [data-slot]')) {
    const text = words[slot.dataset.slot] || '';
    if (slot.dataset.text === text) continue;
    slot.dataset.text = text;
    slot.innerHTML = text;  // made by the ground station, with all that vehicles have said escaped
  }
}
setInterval(tell, 100);
