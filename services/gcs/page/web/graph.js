// The tab Graph: boxes and bundles of the drawn graph are pressed by the keyboard like buttons.

document.addEventListener('keydown', event => {
  if (event.key !== 'Enter' && event.key !== ' ') return;
  const drawn = event.target.closest?.('#gcs svg [role=button][data-do]');
  if (!drawn) return;
  event.preventDefault();
  drawn.dispatchEvent(new MouseEvent('click', { bubbles: true }));
});
