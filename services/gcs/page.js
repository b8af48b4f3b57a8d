((bridge, css) => {
  const LOST = '<b>■ LINK LOST: the ground station has fallen silent, this picture is old</b>';
  let style = document.getElementById('gcs-style');
  if (!style) { style = document.createElement('style'); style.id = 'gcs-style'; document.head.append(style); }
  style.textContent = css;
  document.title = 'UVF ground station';
  document.hasFocus = () => true;
  window.__gcsBridge = bridge;
  if (window.__gcs) return;
  window.__gcs = true;
  const send = text => { const m = window.__viserMutable; if (m) m.sendMessage({type: 'GuiUpdateMessage', uuid: window.__gcsBridge, updates: {value: text}}); };
  document.body.dataset.log = 'notice';
  document.addEventListener('click', e => { const filter = e.target.closest && e.target.closest('[data-log]'); if (filter && filter !== document.body) document.body.dataset.log = filter.dataset.log; });
  const press = e => { const card = e.target.closest && e.target.closest('[data-gcs]'); if (card) send(JSON.stringify([card.dataset.gcs, Date.now()])); };
  document.addEventListener('pointerdown', press);
  document.addEventListener('keydown', e => { if (e.key === 'Enter' || e.key === ' ') press(e); });
  const hand = e => { const page = window.__viserMutable; if (page && e.target === page.canvas && (e.type === 'wheel' || e.buttons)) window.__gcsHand = true; };
  for (const type of ['wheel', 'pointermove']) document.addEventListener(type, hand, {capture: true, passive: true});
  const bar = document.createElement('div');
  bar.id = 'gcs-bar'; bar.setAttribute('role', 'status'); document.body.append(bar);
  let shape = '', told = 0;
  let beat = '', silent = 0, ticked = performance.now();
  setInterval(() => {
    const canvas = window.__viserMutable && window.__viserMutable.canvas;
    if (canvas) {
      const box = canvas.getBoundingClientRect(), root = document.documentElement.style;
      root.setProperty('--gcs-left', box.left + 'px'); root.setProperty('--gcs-width', box.width + 'px');
      const seen = (box.width / Math.max(box.height, 1)).toFixed(3), time = performance.now();
      if (seen !== shape || time - told > 2000) { shape = seen; told = time; send(JSON.stringify([(window.__gcsHand ? 'hand:' : 'shape:') + shape, Date.now()])); }
    }
    const source = document.getElementById('gcs-bar-source');
    const now = performance.now();
    silent += Math.min(now - ticked, 400);  // a page that stood still itself has yet to read what came meanwhile
    ticked = now;
    if (source && source.dataset.beat !== beat) { beat = source.dataset.beat; silent = 0; if (bar.innerHTML !== source.innerHTML) bar.innerHTML = source.innerHTML; }
    const dead = silent > 3000;
    bar.classList.toggle('g-dead', dead);
    if (dead) bar.innerHTML = LOST;
  }, 200);
  let last = null;
  const follow = () => {
    requestAnimationFrame(follow);
    const page = window.__viserMutable, chosen = document.querySelector('#gcs-bar-source .g-follow');
    const control = page && page.cameraControl, node = page && chosen && page.nodeRefFromName['/vehicles/' + chosen.dataset.name];
    if (!window.__gcsFollow || !control || !node) { last = null; return; }
    const at = node.getWorldPosition(node.position.clone());
    const eye = control.getPosition(at.clone()), target = control.getTarget(at.clone());
    const begins = !last || last.name !== chosen.dataset.name;
    const move = begins ? at.clone().sub(target) : at.clone().sub(last.at);
    if (begins) eye.sub(target).setLength(Number(chosen.dataset.distance)).add(target);
    eye.add(move); target.add(move);
    control.setLookAt(eye.x, eye.y, eye.z, target.x, target.y, target.z, false);
    last = {name: chosen.dataset.name, at};
  };
  follow();
})
